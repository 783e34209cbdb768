// The price of the spatial model: nanoseconds and achieved error by tolerance, and ratios to the planar closed form.

#include <algorithm>
#include <cmath>
#include <cstdio>
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

// The same impacts together, in SIMD lanes.
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
}

}  // namespace
}  // namespace ricochet::bench

int main() {
  absl::SetMutexDeadlockDetectionMode(absl::OnDeadlockCycle::kIgnore);
  ricochet::bench::RunAll();
}
