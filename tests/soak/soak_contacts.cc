// Solves millions of random impacts, planar and in space, each under all three laws. Every impact must end with finite
// numbers, must not gain energy under the energetic law, must keep friction inside its cone, and its works must add up.
//
// usage: ricochet_soak [CASES]    of each model; exit code 1 if any impact fails, which is then printed

#include <algorithm>
#include <array>
#include <cinttypes>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <string>
#include <vector>

#include "absl/strings/numbers.h"
#include "absl/strings/str_format.h"
#include "absl/synchronization/mutex.h"
#include "core/models/planar/planar.h"
#include "core/models/restitution_law.h"
#include "core/models/spatial/spatial.h"
#include "tests/support/scenes/planar_scenes.h"
#include "tests/support/scenes/spatial_scenes.h"

namespace ricochet {
namespace {

constexpr std::array kLaws = {RestitutionLaw::kNewton, RestitutionLaw::kPoisson, RestitutionLaw::kEnergetic};

const char* NameOf(Regime regime) {
  static constexpr std::array<const char*, kRegimeCount> kNames = {"unspecified",
                                                                   "frictionless",
                                                                   "rebound",
                                                                   "sliding",
                                                                   "stick in compression",
                                                                   "stick in restitution",
                                                                   "reversal in compression",
                                                                   "reversal in restitution",
                                                                   "locked",
                                                                   "wedged",
                                                                   "separating",
                                                                   "invalid"};
  return kNames[static_cast<size_t>(regime)];
}

std::string ToString(const planar::Problem& p) {
  return absl::StrFormat("W %a %a %a u0 %a v0 %a mu %a mu_s %a law %d coefficient %a", p.w.tt, p.w.tn, p.w.nn, p.u0,
                         p.v0, p.mu, p.mu_static, static_cast<int>(p.law), p.coefficient);
}

std::string ToString(const spatial::Problem& p) {
  return absl::StrFormat("W %a %a %a %a %a %a u0 %a %a v0 %a mu %a mu_s %a law %d coefficient %a tolerance %a", p.w11,
                         p.w12, p.w13, p.w22, p.w23, p.w33, p.u0[0], p.u0[1], p.v0, p.mu, p.mu_static,
                         static_cast<int>(p.law), p.coefficient, p.tolerance);
}

template <typename Impact>
std::vector<double> WorksOf(const Impact& impact) {
  return {impact.work_normal_compression, impact.work_normal_restitution, impact.work_tangential_compression,
          impact.work_tangential_restitution};
}

template <typename Impact>
std::vector<double> CommonNumbersOf(const Impact& impact) {
  std::vector<double> numbers = WorksOf(impact);
  numbers.insert(numbers.end(),
                 {impact.newton, impact.poisson, impact.energetic, impact.tangential, impact.energetic_excess,
                  impact.v1, impact.tau_compression, impact.tau1, impact.energy_change});
  return numbers;
}

std::vector<double> NumbersOf(const planar::Impact& impact) {
  std::vector<double> numbers = CommonNumbersOf(impact);
  numbers.insert(numbers.end(), {impact.u1, impact.f_compression, impact.f1});
  for (size_t i = 0; i < static_cast<size_t>(impact.event_count); ++i) {
    const planar::Instant& event = impact.events[i];
    numbers.insert(numbers.end(), {event.tau, event.f, event.u, event.v});
  }
  return numbers;
}

std::vector<double> NumbersOf(const spatial::Impact& impact) {
  std::vector<double> numbers = CommonNumbersOf(impact);
  numbers.insert(numbers.end(), {impact.u1[0], impact.u1[1], impact.f1[0], impact.f1[1], impact.error_estimate});
  for (size_t i = 0; i < static_cast<size_t>(impact.event_count); ++i) {
    const spatial::Instant& event = impact.events[i];
    numbers.insert(numbers.end(), {event.tau, event.f[0], event.f[1], event.u[0], event.u[1], event.v});
  }
  return numbers;
}

// The last event is the end of restitution; a locked body has none.
template <typename Impact>
bool Ended(const Impact& impact) {
  if (impact.event_count < 2) return false;
  const EventKind last = impact.events[static_cast<size_t>(impact.event_count - 1)].kind;
  return last == (impact.regime == Regime::kLocked ? EventKind::kCompressionEnds : EventKind::kRestitutionEnds);
}

template <typename Impact>
double LedgerResidual(const Impact& impact) {
  double sum = -impact.energy_change;
  for (const double work : WorksOf(impact)) sum += work;
  return std::fabs(sum);
}

template <typename Impact>
double LargestWork(const Impact& impact) {
  double largest = 0.0;
  for (const double work : WorksOf(impact)) largest = std::max(largest, std::fabs(work));
  return largest;
}

// The results of all impacts of one model.
struct Tally {
  std::array<int64_t, kRegimeCount> regimes = {};
  int64_t solves = 0;
  int64_t failures = 0;
  int64_t beyond_doubles = 0;  // An exact value is above the largest double, and comes out infinite as promised.
  int64_t gains = 0;           // Newton's or Poisson's law asked for energy that was not stored, and this was flagged.
  int64_t most_steps = 0;
  double largest_residual = 0.0;  // The largest residual of the works over its limit.

  void Fail(const std::string& what, const std::string& problem) {
    constexpr int64_t kPrinted = 20;
    if (++failures <= kPrinted) std::printf("FAILED: %s: %s\n", what.c_str(), problem.c_str());
  }
};

// The limits for one impact, in its own units.
struct Limits {
  double outside_cone;  // Limit of OutsideCone.
  double energy_gain;   // Limit of the gain under the energetic law.
  double ledger;        // Limit of |sum of works - change of energy|.
};

Limits LimitsOf(const planar::Problem& /*problem*/, const planar::Impact& impact) {
  // tau1 and the works may lie below 2^-1022, where an ulp is that of no more than this.
  constexpr double kSmallest = 0x1p-1074;
  return {.outside_cone = 0.0, .energy_gain = 0.0, .ledger = 0x1p-50 * LargestWork(impact) + 4.0 * kSmallest};
}

Limits LimitsOf(const spatial::Problem& problem, const spatial::Impact& impact) {
  const double speed = std::max(std::hypot(problem.u0[0], problem.u0[1]), std::fabs(problem.v0));
  const double impulse = impact.tau1 + std::hypot(impact.f1[0], impact.f1[1]);
  const double work = speed * impulse;
  // Near rank two, W times large impulses cancels to the velocities, with an error of an ulp of the terms.
  const double cancelled = 0x1p-52 * (problem.w11 + problem.w22 + problem.w33) * impulse;
  constexpr double kRounding = 1e-13;
  return {.outside_cone = impact.error_estimate * speed,
          .energy_gain = impact.error_estimate * work,
          .ledger = kRounding * work + cancelled * impulse};
}

// Returns by how much |f1| exceeds the most that friction can give.
double OutsideCone(const planar::Problem& problem, const planar::Impact& impact) {
  constexpr double kSmallest = 0x1p-1074;
  const double most = problem.mu_static * (impact.tau1 * (1.0 + 0x1p-50) + kSmallest) + kSmallest;
  return std::max(0.0, std::fabs(impact.f1) - most);
}

// The least |Wtt df| of all df that bring f1 into the cone of friction: the error of u that goes with this f1. In the
// principal axes of Wtt, df minimises it if (lambda^2 + nu) (f1 - df) = lambda^2 f1 for some nu >= 0.
double OutsideCone(const spatial::Problem& problem, const spatial::Impact& impact) {
  constexpr double kRounding = 1e-13;
  const double most = problem.mu_static * impact.tau1 * (1.0 + kRounding);
  if (std::hypot(impact.f1[0], impact.f1[1]) <= most) return 0.0;
  const double angle = 0.5 * std::atan2(2.0 * problem.w12, problem.w11 - problem.w22);
  const double c = std::cos(angle), s = std::sin(angle);
  const double along = c * impact.f1[0] + s * impact.f1[1];
  const double across = c * impact.f1[1] - s * impact.f1[0];
  const double first = problem.w11 * c * c + 2.0 * problem.w12 * c * s + problem.w22 * s * s;
  const double second = problem.w11 * s * s - 2.0 * problem.w12 * c * s + problem.w22 * c * c;
  const auto kept = [](double lambda, double nu) { return lambda * lambda / (lambda * lambda + nu); };
  double low = 0.0;
  double high = first * first;
  const auto size = [&](double nu) { return std::hypot(along * kept(first, nu), across * kept(second, nu)); };
  while (size(high) > most) high *= 2.0;
  for (int i = 0; i < 200; ++i) {
    const double nu = 0.5 * (low + high);
    (size(nu) > most ? low : high) = nu;
  }
  return std::hypot(first * along * (1.0 - kept(first, high)), second * across * (1.0 - kept(second, high)));
}

bool GaveUp(const planar::Impact& /*impact*/) { return false; }
bool GaveUp(const spatial::Impact& impact) { return !impact.Converged(); }

int64_t Steps(const planar::Impact& impact) { return impact.event_count; }
int64_t Steps(const spatial::Impact& impact) { return impact.steps; }

// The reason why this impact breaks a claim; empty if it breaks none.
template <typename Problem, typename Impact>
std::string Complaint(const Problem& problem, const Impact& impact, const Limits& limits) {
  if (GaveUp(impact) || !Ended(impact)) return "did not end";
  if (OutsideCone(problem, impact) > limits.outside_cone) return "friction outside its cone";
  if (LedgerResidual(impact) > limits.ledger) {
    return absl::StrFormat("the ledger is open by %.2g of its limit", LedgerResidual(impact) / limits.ledger);
  }
  if (problem.law != RestitutionLaw::kEnergetic) return "";
  if (impact.energy_change > limits.energy_gain) return absl::StrFormat("gains %.2g J", impact.energy_change);
  if (impact.sharp_limit_broken || impact.energy_limit_broken) return "flagged as inadmissible";
  return "";
}

using planar::Solve;
using spatial::Solve;

template <typename Problem>
void Check(const Problem& problem, bool any_exponent, Tally& tally) {
  const auto impact = Solve(problem);
  ++tally.solves;
  ++tally.regimes[static_cast<size_t>(impact.regime)];
  tally.most_steps = std::max(tally.most_steps, Steps(impact));
  tally.gains += impact.energy_limit_broken ? 1 : 0;
  bool infinite = false;
  for (const double number : NumbersOf(impact)) {
    if (std::isnan(number)) return tally.Fail("not a number", ToString(problem));
    infinite |= std::isinf(number);
  }
  if (infinite && any_exponent) {
    ++tally.beyond_doubles;
    return;
  }
  if (infinite) return tally.Fail("infinite", ToString(problem));
  const Limits limits = LimitsOf(problem, impact);
  tally.largest_residual = std::max(tally.largest_residual, LedgerResidual(impact) / limits.ledger);
  if (const std::string complaint = Complaint(problem, impact, limits); !complaint.empty()) {
    tally.Fail(complaint, ToString(problem));
  }
}

template <typename Problem>
void CheckUnderAllLaws(Problem problem, bool any_exponent, Tally& tally) {
  const double given = problem.coefficient;
  for (const RestitutionLaw law : kLaws) {
    problem.law = law;
    problem.coefficient = law == RestitutionLaw::kEnergetic ? std::min(given, 1.0) : given;
    Check(problem, any_exponent, tally);
  }
}

// Every fourth problem is drawn from all doubles; the others are typical, near rank one or near a threshold of the
// path.
Tally PlanarCases(int64_t cases) {
  Tally tally;
  planar::SceneSource source(101);
  for (int64_t i = 0; i < cases; ++i) {
    const bool any_exponent = i % 4 == 0;
    CheckUnderAllLaws(any_exponent ? source.OverAllDoubles() : source.Any(), any_exponent, tally);
  }
  return tally;
}

spatial::Problem AnySpatial(spatial::SceneSource& source) {
  switch (source.Below(16)) {
    case 0:
      return source.WithDegreesOfFreedom(1);
    case 1:
      return source.WithDegreesOfFreedom(2);
    case 2: {
      spatial::Problem problem = source.Below(2) == 0 ? source.Typical() : source.NearSingular();
      problem.u0 = {};
      return problem;
    }
    default:
      return source.Below(2) == 0 ? source.Typical() : source.NearSingular();
  }
}

// The problems are typical, nearly singular, without slip at first, or of rank one and two; tolerances are 1e-4 to
// 1e-12.
Tally SpatialCases(int64_t cases) {
  Tally tally;
  spatial::SceneSource source(102);
  for (int64_t i = 0; i < cases; ++i) {
    spatial::Problem problem = AnySpatial(source);
    problem.tolerance = std::pow(10.0, -source.Uniform(4.0, 12.0));
    if (source.Below(4) == 0) problem.mu_static *= source.Uniform(1.0, 1.5);
    CheckUnderAllLaws(problem, false, tally);
  }
  return tally;
}

void Report(const char* model, const char* step, int64_t cases, const Tally& tally) {
  std::printf("%s: %" PRId64 " cases under three laws, %" PRId64 " impacts\n", model, cases, tally.solves);
  for (size_t i = 0; i < tally.regimes.size(); ++i) {
    if (tally.regimes[i] == 0) continue;
    std::printf("  %-38s %" PRId64 "\n", NameOf(static_cast<Regime>(i)), tally.regimes[i]);
  }
  std::printf("  energy gained as asked, and flagged    %" PRId64 "\n", tally.gains);
  std::printf("  with numbers beyond the largest double %" PRId64 "\n", tally.beyond_doubles);
  std::printf("  most %-33s %" PRId64 "\n", step, tally.most_steps);
  std::printf("  largest residual of the ledger         %.2g of its limit\n", tally.largest_residual);
  std::printf("  failures                               %" PRId64 "\n", tally.failures);
}

int Main(const std::vector<std::string>& arguments) {
  int64_t cases = 1'000'000;
  if (arguments.size() > 1 || (arguments.size() == 1 && (!absl::SimpleAtoi(arguments[0], &cases) || cases < 1))) {
    std::fprintf(stderr, "usage: ricochet_soak [CASES]    a number >= 1, of each model\n");
    return 2;
  }
  const Tally planar = PlanarCases(cases);
  Report("Planar", "events", cases, planar);
  const Tally spatial = SpatialCases(cases);
  Report("Spatial", "steps", cases, spatial);
  return planar.failures + spatial.failures == 0 ? 0 : 1;
}

}  // namespace
}  // namespace ricochet

int main(int argc, char** argv) {
  absl::SetMutexDeadlockDetectionMode(absl::OnDeadlockCycle::kIgnore);
  return ricochet::Main({argv + 1, argv + argc});
}
