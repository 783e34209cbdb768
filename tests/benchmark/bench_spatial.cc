// The price of the spatial model: nanoseconds and achieved error by tolerance, and ratios to the planar closed form.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include "absl/strings/str_format.h"
#include "absl/synchronization/mutex.h"
#include "core/models/planar/planar.h"
#include "core/models/spatial/columns.h"
#include "core/models/spatial/spatial.h"
#include "tests/benchmark/measure.h"
#include "tests/support/scenes/known_contacts.h"
#include "tests/support/scenes/spatial_scenes.h"

namespace ricochet::bench {
namespace {

using spatial::Problem;

constexpr int kRounds = 21;
constexpr size_t kCount = 1000;

template <typename Next>
std::vector<Problem> Problems(double tolerance, const Next& next) {
  std::vector<Problem> problems(kCount);
  for (Problem& problem : problems) {
    problem = next();
    problem.tolerance = tolerance;
  }
  return problems;
}

// The median and the largest error over max(|u0|, |v0|), compared with the solution at the tightest tolerance.
struct Errors {
  double median, largest;
};
Errors ErrorsOf(const std::vector<Problem>& problems) {
  std::vector<double> errors;
  for (const Problem& problem : problems) {
    Problem tight = problem;
    tight.tolerance = 1e-14;
    const spatial::Impact a = Solve(problem);
    const spatial::Impact b = Solve(tight);
    const double scale = std::max(std::hypot(problem.u0[0], problem.u0[1]), std::fabs(problem.v0));
    errors.push_back(std::max(std::hypot(a.u1[0] - b.u1[0], a.u1[1] - b.u1[1]), std::fabs(a.v1 - b.v1)) / scale);
  }
  return {Median(errors), *std::max_element(errors.begin(), errors.end())};
}

void Measure(const char* what, const std::vector<Problem>& problems) {
  std::vector<planar::Problem> planar_problems;
  for (const Problem& problem : problems) planar_problems.push_back(InPlane(problem));
  const Comparison time = Compare(
      kRounds,
      [&] {
        double sum = 0.0;
        for (const Problem& problem : problems) sum += Solve(problem).v1;
        DoNotOptimize(sum);
      },
      [&] {
        double sum = 0.0;
        for (const planar::Problem& problem : planar_problems) sum += planar::Solve(problem).v1;
        DoNotOptimize(sum);
      });
  double terms = 0.0;
  for (const Problem& problem : problems) terms += static_cast<double>(Solve(problem).right_hand_sides);
  const Errors errors = ErrorsOf(problems);
  Print(absl::StrFormat("%s, tolerance %.0e", what, problems[0].tolerance),
        absl::StrFormat("%.0f ns", time.seconds_a / kCount * 1e9),
        absl::StrFormat("error %.1e (median), %.1e (largest); %.0f series terms; %.1f x planar", errors.median,
                        errors.largest, terms / kCount, time.ratio));
}

// Solves the same impacts together, in SIMD lanes.
void MeasureColumns(const char* what, const std::vector<Problem>& problems) {
  std::vector<spatial::Impact> impacts(problems.size());
  const Comparison time = Compare(
      kRounds,
      [&] {
        SolveColumns(problems, absl::MakeSpan(impacts));
        DoNotOptimize(impacts.back().v1);
      },
      [&] {
        double sum = 0.0;
        for (const Problem& problem : problems) sum += Solve(problem).v1;
        DoNotOptimize(sum);
      });
  Print(absl::StrFormat("%s in columns, tolerance %.0e", what, problems[0].tolerance),
        absl::StrFormat("%.0f ns", time.seconds_a / kCount * 1e9),
        absl::StrFormat("%.2f of single impacts", time.ratio));
}

// Seconds of one solve: the least of several rounds, because other programs interrupt some of them.
double SecondsOf(const Problem& problem) {
  constexpr int kTimes = 16;
  double least = std::numeric_limits<double>::infinity();
  for (int round = 0; round < 7; ++round) {
    least = std::min(least, Seconds([&] {
                       for (int i = 0; i < kTimes; ++i) DoNotOptimize(Solve(problem).v1);
                     }));
  }
  return least / kTimes;
}

// Reports whether a looser tolerance ever takes longer than a tighter one, in the mean or in single scenes.
void CompareTolerances(const std::vector<Problem>& problems) {
  std::vector<double> tighter;
  for (const double tolerance : {1e-12, 1e-10, 1e-8, 1e-7, 1e-6, 1e-5, 1e-4, 1e-3, 1e-2}) {
    std::vector<double> seconds;
    for (Problem problem : problems) {
      problem.tolerance = tolerance;
      seconds.push_back(SecondsOf(problem));
    }
    size_t slower = 0;
    for (size_t i = 0; i < tighter.size(); ++i) slower += seconds[i] > 1.2 * tighter[i] ? 1u : 0u;
    const double mean = std::accumulate(seconds.begin(), seconds.end(), 0.0) / kCount;
    std::string note = "the tightest";
    if (!tighter.empty()) {
      const double tight_mean = std::accumulate(tighter.begin(), tighter.end(), 0.0) / kCount;
      note = absl::StrFormat(
          "%.2f x the mean of the tolerance above, goal 1; %.1f %% of scenes longer by a fifth, goal 1 %%",
          mean / tight_mean, 100.0 * static_cast<double>(slower) / kCount);
    }
    Print(absl::StrFormat("tolerance %.0e", tolerance), absl::StrFormat("%.0f ns", mean * 1e9), note);
    tighter = std::move(seconds);
  }
}

void RunAll() {
  std::printf("Spatial impact, one solve\n");
  for (const double tolerance : {1e-3, 1e-6, 1e-10}) {
    spatial::SceneSource typical(1);
    const std::vector<Problem> problems = Problems(tolerance, [&] { return typical.Typical(); });
    Measure("1000 typical scenes", problems);
    MeasureColumns("1000 typical scenes", problems);
    spatial::SceneSource singular(2);
    Measure("1000 nearly singular scenes", Problems(tolerance, [&] { return singular.NearSingular(); }));
  }
  std::printf("Spatial impact, 1000 typical scenes, by tolerance\n");
  spatial::SceneSource typical(1);
  CompareTolerances(Problems(0.0, [&] { return typical.Typical(); }));
}

}  // namespace
}  // namespace ricochet::bench

int main() {
  absl::SetMutexDeadlockDetectionMode(absl::OnDeadlockCycle::kIgnore);
  ricochet::bench::RunAll();
}
