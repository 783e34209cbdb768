// Planar impacts close to everything that is singular, against their simulation in ball arithmetic.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <vector>

#include "core/models/planar/planar.h"
#include "tests/hard_cases/hard_case_table.h"
#include "tests/hard_cases/naive_planar.h"
#include "tests/support/oracles/planar_oracle.h"
#include "tests/support/scenes/planar_scenes.h"

namespace ricochet::planar {
namespace {

constexpr double kPromisedUlps = 1.0;  // core/models/planar/planar.h
constexpr int kProblemsPerCase = 300;

struct HardCase {
  const char* name;
  const char* why;
  std::function<Problem(SceneSource&)> next;
};

double WorstError(const Problem& problem, const ExactImpact& exact, const Impact& impact) {
  if (impact.regime != exact.regime || static_cast<size_t>(impact.event_count) != exact.events.size()) {
    return kOtherRegime;
  }
  const OutputErrors errors = ErrorsOf(problem, impact, exact);
  return *std::max_element(errors.begin(), errors.end());
}

HardCaseResult ResultOf(const HardCase& hard) {
  HardCaseResult result = {.name = hard.name, .why = hard.why, .promised = kPromisedUlps};
  SceneSource source(5);
  for (int i = 0; i < kProblemsPerCase; ++i) {
    const Problem problem = hard.next(source);
    const ExactImpact exact = SolveExactly(problem);
    const double seen = WorstError(problem, exact, Solve(problem));
    result.seen = std::max(result.seen, seen == kOtherRegime ? std::numeric_limits<double>::infinity() : seen);
    const double naive = WorstError(problem, exact, NaiveSolve(problem));
    result.naive = naive == kOtherRegime || result.naive == kOtherRegime ? kOtherRegime : std::max(result.naive, naive);
  }
  return result;
}

// The input lies 1e-15 to either side of the critical one, or is the double nearest to it.
HardCase Near(const char* name, const char* why, SceneSource::SignChange change) {
  return {name, why, [change](SceneSource& source) {
            constexpr double kDistance = 1e-15;
            return source.NearSignChange(change, 1.0 + kDistance * (static_cast<double>(source.Below(3)) - 1.0));
          }};
}

HardCase With(const char* name, const char* why, void (*change)(SceneSource&, Problem&)) {
  return {name, why, [change](SceneSource& source) {
            Problem problem = source.Everyday();
            change(source, problem);
            return problem;
          }};
}

// A pair of a light and a heavy body: the heavy one adds a trillionth of W.
Problem OfUnequalMasses(SceneSource& source) {
  constexpr double kRatio = 1e12;
  Problem problem = source.Everyday();
  const double offset = source.Uniform(-1.0, 1.0);
  problem.w.tt += (1.0 + offset * offset) / kRatio;
  problem.w.tn += offset / kRatio;
  problem.w.nn += 1.0 / kRatio;
  return problem;
}

// The mobility along t is 1e12 times that along n.
Problem OfUnequalMobilities(SceneSource& source) {
  constexpr double kRatio = 1e12;
  Problem problem = source.Everyday();
  problem.w.tt *= kRatio;
  problem.w.tn *= std::sqrt(kRatio);
  problem.mu /= std::sqrt(kRatio);
  problem.mu_static = problem.mu;
  return problem;
}

std::vector<HardCase> HardCases() {
  using Change = SceneSource::SignChange;
  return {
      {"W of rank one up to rounding", "det W is noise: u and v have to vanish together",
       [](SceneSource& source) { return source.RankOne(); }},
      {"det W from 2⁻¹⁰ to 8ε of Wtt Wnn", "sticking divides by it",
       [](SceneSource& source) { return source.NearRankOne(); }},
      {"det W near 4ε of Wtt Wnn", "where rank one begins",
       [](SceneSource& source) {
         return source.NearSignChange(Change::kDeterminant, 1.0 + 0x1p-50 * source.Uniform(0.5, 2.0));
       }},
      Near("μ_s Wtt = \\|Wtn\\| ± 10⁻¹⁵", "stick or reversal", Change::kStick),
      Near("μ \\|Wtn\\| = Wnn ± 10⁻¹⁵", "v rises or falls, and hardly either", Change::kJam),
      Near("slip stops at the end of compression ± 10⁻¹⁵", "two events in one", Change::kStopAtRest),
      Near("slip stops at the end of restitution ± 10⁻¹⁵", "two events in one", Change::kStopAtEnd),
      Near("f₁ = 0 ± 10⁻¹⁵", "impulses of two slips cancel", Change::kFrictionImpulse),
      Near("η = 1 ± 10⁻¹⁵ by Newton or Poisson", "the excess is a difference of works", Change::kDeformation),
      Near("E⁺ = E⁻ ± 10⁻¹⁵ by Newton or Poisson", "four works cancel", Change::kEnergy),
      {"u₀ = 0", "no slip to have a direction", [](SceneSource& source) { return source.NoSlip(); }},
      With("u₀ = ±10⁻³⁰⁰", "slip stops before tau has a digit of what follows",
           [](SceneSource& source, Problem& problem) { problem.u0 = source.Sign() * 1e-300; }),
      With("v₀ = −10⁻³⁰⁰", "works below the smallest double",
           [](SceneSource&, Problem& problem) { problem.v0 = -1e-300; }),
      With("v₀ = −2⁻¹⁰⁷⁴", "one bit of velocity", [](SceneSource&, Problem& problem) { problem.v0 = -0x1p-1074; }),
      {"masses 1 : 10¹²", "W is a sum of unequals", OfUnequalMasses},
      {"mobilities 10¹² : 1", "W is of unequals", OfUnequalMobilities},
      With("self-locking, μ up to 10³ Wnn/\\|Wtn\\|", "v falls first; slip has to stop before it rises",
           [](SceneSource& source, Problem& problem) {
             if (problem.w.tn == 0.0) problem.w.tn = 0.1 * std::sqrt(problem.w.tt * problem.w.nn);
             problem.mu = problem.mu_static =
                 problem.w.nn / std::fabs(problem.w.tn) * std::exp2(source.Uniform(0.0, 10.0));
             problem.u0 = std::copysign(problem.u0, problem.w.tn);
           }),
      {"locked", "rank one and friction: nothing may be left of u and v",
       [](SceneSource& source) {
         Problem problem = source.RankOne();
         problem.mu = problem.mu_static = problem.w.nn / std::fabs(problem.w.tn) * (1.0 + 0x1p-40);
         return problem;
       }},
  };
}

// On everyday impacts the naive formulas serve: on the hard cases their arithmetic fails, not their path.
TEST(PlanarHardCasesTest, NaiveFormulasServeEverydayProblems) {
  SceneSource source(4);
  for (int i = 0; i < 1000; ++i) {
    const Problem problem = source.Everyday();
    const ExactImpact exact = SolveExactly(problem);
    const Impact naive = NaiveSolve(problem);
    ASSERT_EQ(naive.regime, exact.regime) << ToString(problem);
    EXPECT_NEAR(naive.u1, exact.end().u.Nearest(), 1e-9) << ToString(problem);
    EXPECT_NEAR(naive.v1, exact.end().v.Nearest(), 1e-9) << ToString(problem);
  }
}

// A sign that rounding may have turned is not proved, so that what plain arithmetic proves is the exact course.
TEST(PlanarHardCasesTest, PlainArithmeticProvesNoSignThatRoundingTurned) {
  for (const HardCase& hard : HardCases()) {
    SceneSource source(7);
    for (int i = 0; i < kProblemsPerCase; ++i) {
      const Problem problem = hard.next(source);
      const PlainImpact plain = SolvePlain(problem);
      if (!plain.proved) continue;
      const ExactImpact exact = SolveExactly(problem);
      ASSERT_EQ(plain.impact.regime, exact.regime) << hard.name << ": " << ToString(problem);
      ASSERT_EQ(plain.impact.w_rank, exact.w_rank) << hard.name << ": " << ToString(problem);
      ASSERT_EQ(static_cast<size_t>(plain.impact.event_count), exact.events.size()) << hard.name;
      for (size_t k = 0; k < exact.events.size(); ++k) ASSERT_EQ(plain.impact.events[k].kind, exact.events[k].kind);
      if (problem.coefficient == 0.0 || exact.regime == Regime::kLocked) continue;
      ASSERT_EQ(plain.impact.sharp_limit_broken, exact.energetic > Ball(1.0)) << hard.name << ": " << ToString(problem);
      ASSERT_EQ(plain.impact.energy_limit_broken, exact.energy_change > Ball(0.0))
          << hard.name << ": " << ToString(problem);
    }
  }
}

TEST(PlanarHardCasesTest, KeepTheirPromise) {
  std::vector<HardCaseResult> results;
  for (const HardCase& hard : HardCases()) results.push_back(ResultOf(hard));
  SceneSource source(6);
  HardCaseResult all = {.name = "inputs of any exponent", .why = "products leave the range", .promised = kPromisedUlps};
  for (int i = 0; i < kProblemsPerCase / 5; ++i) {
    const Problem problem = source.OverAllDoubles();
    const ExactImpact exact = SolveExactly(problem);
    const double seen = WorstError(problem, exact, Solve(problem));
    all.seen = std::max(all.seen, seen == kOtherRegime ? std::numeric_limits<double>::infinity() : seen);
    if (WorstError(problem, exact, NaiveSolve(problem)) == kOtherRegime) all.naive = kOtherRegime;
  }
  results.push_back(all);
  CheckTable("planar", "ulp", results);
}

}  // namespace
}  // namespace ricochet::planar
