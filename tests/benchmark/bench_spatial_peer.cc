// The spatial model, compared with CVODE on the original equations at the same accuracy.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <string>
#include <vector>

#include "absl/functional/function_ref.h"
#include "absl/strings/str_format.h"
#include "absl/synchronization/mutex.h"
#include "core/models/spatial/solver-inl.h"
#include "core/models/spatial/spatial.h"
#include "tests/benchmark/cvode_peer.h"
#include "tests/benchmark/measure.h"
#include "tests/support/scenes/spatial_scenes.h"

namespace ricochet::bench {
namespace {

using spatial::Impact;
using spatial::Problem;

constexpr int kCount = 1000;
constexpr int kRounds = 5;

// A solver's answer to one problem.
struct Answer {
  bool ended = false;
  double error = 0.0;  // Error of the velocities over max(|u0|, |v0|).
};

// The reference is the model's own solver with 64-bit mantissas and a tolerance below the resolution of doubles.
struct Case {
  Problem problem;
  Impact reference;

  // Some W near rank two do not determine a velocity in any arithmetic.
  bool known() const { return reference.Converged() && reference.error_estimate <= 1e-12; }

  Answer Judge(bool ended, const std::array<double, 2>& u1, double v1) const {
    const double scale = std::max(std::hypot(problem.u0[0], problem.u0[1]), std::fabs(problem.v0));
    const double u_error = std::hypot(u1[0] - reference.u1[0], u1[1] - reference.u1[1]);
    return {ended, std::max(u_error, std::fabs(v1 - reference.v1)) / scale};
  }
};

std::vector<Case> Cases(absl::FunctionRef<Problem()> next) {
  std::vector<Case> cases;
  for (int i = 0; i < kCount; ++i) {
    const Problem problem = next();
    cases.push_back(
        {problem, spatial::HWY_NAMESPACE::Solver<long double>(problem, problem.Delassus().Rank(), 1e-16L).Run()});
  }
  return cases;
}

// The results of one solver over all cases.
struct Run {
  int gave_up = 0;
  std::vector<double> errors;  // Errors of the cases that ended and whose answer is known.
  int within = 0;              // Number of these errors that are within the tolerance.
};
Run RunOver(const std::vector<Case>& cases, double asked, absl::FunctionRef<Answer(const Case&)> solve) {
  Run run;
  for (const Case& c : cases) {
    const Answer answer = solve(c);
    run.gave_up += answer.ended ? 0 : 1;
    if (!answer.ended || !c.known()) continue;
    run.errors.push_back(answer.error);
    run.within += answer.error <= asked ? 1 : 0;
  }
  return run;
}

Answer Ours(const Case& c, double tolerance) {
  Problem problem = c.problem;
  problem.tolerance = tolerance;
  const Impact impact = Solve(problem);
  return c.Judge(impact.Converged(), impact.u1, impact.v1);
}

Answer Theirs(CvodePeer& peer, const Case& c, double tolerance) {
  const PeerImpact impact = peer.Solve(c.problem, tolerance);
  return c.Judge(impact.ended, impact.u1, impact.v1);
}

// CVODE controls local errors. This finds the loosest tolerance, by half decades, at which 99 of 100 answers are within
// the error asked for.
double ToleranceForSameAccuracy(CvodePeer& peer, const std::vector<Case>& cases, double asked) {
  constexpr double kTightest = 1e-14;
  double tolerance = asked;
  const auto enough = [&] {
    const Run run = RunOver(cases, asked, [&](const Case& c) { return Theirs(peer, c, tolerance); });
    return 100 * run.within >= 99 * static_cast<int>(run.errors.size());
  };
  while (!enough() && tolerance > kTightest) tolerance *= std::sqrt(0.1);
  return tolerance;
}

// Seconds for each case that CVODE ends, as medians over the rounds.
struct Times {
  std::vector<double> ours, theirs, ratios;
};
Times TimesOf(CvodePeer& peer, const std::vector<Case>& cases, double asked, double their_tolerance) {
  Times times;
  for (const Case& c : cases) {
    if (!Theirs(peer, c, their_tolerance).ended) continue;
    const Comparison time = Compare(
        kRounds, [&] { DoNotOptimize(Ours(c, asked).error); },
        [&] { DoNotOptimize(Theirs(peer, c, their_tolerance).error); });
    times.ours.push_back(time.seconds_a);
    times.theirs.push_back(time.seconds_b);
    times.ratios.push_back(1.0 / time.ratio);
  }
  return times;
}

double Mean(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double value : values) sum += value;
  return sum / static_cast<double>(values.size());
}

void PrintRun(const std::string& who, const std::vector<double>& seconds, const Run& run) {
  Print(who, absl::StrFormat("%.2f us", Median(seconds) * 1e6),
        absl::StrFormat("mean %.2f us; error %.1e (median), %.1e (99 %%), %.1e (largest); %d of %d within; gave up %d",
                        Mean(seconds) * 1e6, Median(run.errors), Quantile(run.errors, 0.99), Quantile(run.errors, 1.0),
                        run.within, run.errors.size(), run.gave_up));
}

void Measure(CvodePeer& peer, const char* what, const std::vector<Case>& cases, double asked) {
  const double their_tolerance = ToleranceForSameAccuracy(peer, cases, asked);
  const Times times = TimesOf(peer, cases, asked, their_tolerance);
  const auto known = std::count_if(cases.begin(), cases.end(), [](const Case& c) { return c.known(); });
  std::printf("Spatial impact, %d %s cases, %.0e asked; errors of the %d that are known to 1e-12\n", kCount, what,
              asked, static_cast<int>(known));
  PrintRun("ricochet", times.ours, RunOver(cases, asked, [&](const Case& c) { return Ours(c, asked); }));
  PrintRun(absl::StrFormat("CVODE, told %.1e", their_tolerance), times.theirs,
           RunOver(cases, asked, [&](const Case& c) { return Theirs(peer, c, their_tolerance); }));
  Print("ratio", absl::StrFormat("%.0f x", Median(times.ratios)),
        absl::StrFormat("CVODE / ricochet, median of cases; of the means %.0f x; cases that CVODE gave up left out",
                        Mean(times.theirs) / Mean(times.ours)));
}

// Cases whose slip never stops and is never near 0. Their equations are smooth, so that CVODE is an independent check.
void CrossCheck(CvodePeer& peer, const std::vector<Case>& cases) {
  constexpr double kTolerance = 1e-13;
  constexpr double kLeastSlip = 0.1;
  std::vector<double> differences;
  for (const Case& c : cases) {
    double slip = std::numeric_limits<double>::infinity();
    for (int i = 0; i < c.reference.event_count; ++i) {
      const spatial::Instant& event = c.reference.events[static_cast<size_t>(i)];
      slip = std::min(slip, std::hypot(event.u[0], event.u[1]));
    }
    if (c.reference.regime != Regime::kSliding || slip < kLeastSlip) continue;
    const Answer answer = Theirs(peer, c, kTolerance);
    if (answer.ended) differences.push_back(answer.error);
  }
  std::printf("The reference against CVODE at %.0e, %d typical cases that slide throughout\n", kTolerance,
              static_cast<int>(differences.size()));
  Print("difference", absl::StrFormat("%.1e", Median(differences)),
        absl::StrFormat("median; %.1e (largest)", Quantile(differences, 1.0)));
}

void RunAll() {
  CvodePeer peer;
  spatial::SceneSource typical_source(1);
  const std::vector<Case> typical = Cases([&] { return typical_source.Typical(); });
  spatial::SceneSource singular_source(2);
  const std::vector<Case> singular = Cases([&] { return singular_source.NearSingular(); });
  CrossCheck(peer, typical);
  for (const double tolerance : {1e-6, 1e-10}) {
    Measure(peer, "typical", typical, tolerance);
    Measure(peer, "nearly singular", singular, tolerance);
  }
}

}  // namespace
}  // namespace ricochet::bench

int main() {
  absl::SetMutexDeadlockDetectionMode(absl::OnDeadlockCycle::kIgnore);
  ricochet::bench::RunAll();
}
