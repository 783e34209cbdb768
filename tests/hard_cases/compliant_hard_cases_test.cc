// Impacts with tangential compliance close to where their paths fork, degenerate or leave the range, against the
// equations in time by Taylor series at 58 digits.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <vector>

#include "core/answer/model_outcomes.h"
#include "core/contact/reduction.h"
#include "core/models/compliant/compliant.h"
#include "ricochet/outcome.h"
#include "tests/hard_cases/hard_case_table.h"
#include "tests/hard_cases/naive_compliant.h"
#include "tests/support/oracles/compliant_oracle.h"
#include "tests/support/scenes/compliant_hard_scenes.h"
#include "tests/support/scenes/compliant_scenes.h"
#include "tests/support/scenes/made_outcome.h"

namespace ricochet::compliant {
namespace {

struct HardCase {
  const char* name;
  const char* why;
  std::function<Problem(SceneSource&)> next;
  int problems = 20;
};

// A wrong regime counts as worse than NaN, and NaN as worse than any number.
double Worse(double x, double y) {
  if (x == kOtherRegime || y == kOtherRegime) return kOtherRegime;
  if (std::isnan(x) || std::isnan(y)) return std::numeric_limits<double>::quiet_NaN();
  return std::max(x, y);
}

double NaiveError(const Problem& problem, const ExactImpact& exact) {
  const NaiveImpact naive = NaiveSolve(problem);
  if (std::isnan(naive.u1)) return naive.u1;
  return naive.regime == exact.regime ? VelocityError(problem, naive.u1, naive.v1, exact) : kOtherRegime;
}

// The model promises the answer of inputs within 16 eps of those given (core/models/compliant/compliant.h).
bool IsRegimeNear(Regime regime, const Problem& problem) {
  for (double PlanarProblem::*input : {&PlanarProblem::u0, &PlanarProblem::mu}) {
    for (const double factor : {1.0, 1.0 - 0x1p-48, 1.0 + 0x1p-48}) {
      Problem other = problem;
      other.contact.*input *= factor;
      if (SolveExactly(other).regime == regime) return true;
    }
  }
  return false;
}

HardCaseResult ResultOf(const HardCase& hard) {
  HardCaseResult result = {.name = hard.name, .why = hard.why};
  SceneSource source(31);
  for (int i = 0; i < hard.problems; ++i) {
    const Problem problem = hard.next(source);
    const ExactImpact exact = SolveExactly(problem);
    const Impact impact = Solve(problem);
    EXPECT_TRUE(exact.ends) << hard.name << " " << ToString(problem);
    EXPECT_TRUE(impact.regime == exact.regime || IsRegimeNear(impact.regime, problem))
        << hard.name << " " << ToString(problem);
    const double error = VelocityError(problem, impact.u1, impact.v1, exact);
    EXPECT_LE(error, impact.error_estimate) << hard.name << " " << ToString(problem);
    result.promised = std::max(result.promised, impact.error_estimate);
    result.seen = std::max(result.seen, error);
    result.naive = Worse(result.naive, NaiveError(problem, exact));
  }
  return result;
}

HardCase With(const char* name, const char* why, void (*change)(SceneSource&, Problem&), int problems = 20) {
  return {name, why,
          [change](SceneSource& source) {
            Problem problem = Everyday(source);
            change(source, problem);
            return problem;
          },
          problems};
}

std::vector<HardCase> HardCases() {
  return {
      With("\\|u₀\\| = μ ratio² \\|v₀\\| ± 10⁻¹⁵", "does it start in a stick or in a slide?", StartOnTheCone, 60),
      With("\\|u₀\\| = μ ratio² \\|v₀\\| ± 10⁻¹⁵ and A = 0 ± 10⁻¹⁵", "slip neither grows nor falls",
           StartOnTheConeWithoutGrowth),
      With("μ Wtt = \\|Wtn\\| ± 10⁻¹⁵", "stick or reversal of the rigid limit", CriticalFriction),
      With("B = Wnn − sμWtn = ± 10⁻¹⁵ Wnn", "cosine, line or cosh of time", NoLift),
      {"μ an ulp from another sequence of sections", "sections of some ulp, cones touched and left", Fork},
      With("slip stops at the end of compression ± 10⁻¹⁵", "two events in one", StopAtTheEndOfCompression),
      With("slip stops at the end of contact ± 10⁻¹⁵", "two events in one", StopAtTheEndOfContact),
      With("equal frequencies ± 10⁻¹⁵, Wtn to 10⁻²⁰ Wnn", "no eigenvector is better than another", EqualFrequencies),
      With(
          "ratio² = 10⁻⁹", "10³ periods along the surface in one along n",
          [](SceneSource& source, Problem& p) {
            p.ratio_squared = 1e-9;
            p.contact.w.tt = 0.01 * p.contact.w.nn;
            p.contact.w.tn = source.Uniform(-0.5, 0.5) * std::sqrt(p.contact.w.tt * p.contact.w.nn);
          },
          2),
      With("ratio² = 10⁹", "the tangential force is 10⁻⁹ of the normal one",
           [](SceneSource&, Problem& p) { p.ratio_squared = 1e9; }),
      With("Wtn = 0 or 10⁻³⁰⁰", "angles and eigenvectors of 0",
           [](SceneSource& source, Problem& p) { p.contact.w.tn = source.Below(2) == 0 ? 0.0 : 1e-300; }),
      {"W of rank one up to rounding", "det W is noise: u and v have to vanish together", Rod},
      With("det W from 10⁻⁶ to 10⁻¹⁴ of Wtt Wnn", "the slow frequency is its root", NearlyARod),
      With("det W from 10⁻³ to 10⁻⁴, and \\|μWtn\\| > Wnn", "all but wedged", HeldForLong, 2),
      With("masses 1 : 10¹²", "W is a sum of unequals", UnequalMasses),
      With("mobilities 10¹² : 1", "W is of unequals", UnequalMobilities, 3),
      With("η = 1", "nothing may be lost to deformation",
           [](SceneSource&, Problem& p) { p.contact.coefficient = 1.0; }),
      With("η from 10⁻¹² to 10⁻³", "the line of unloading is as steep as 10²⁴",
           [](SceneSource& source, Problem& p) { p.contact.coefficient = source.LogUniform(1e-12, 1e-3); }),
      With("η = 0", "no line of unloading", [](SceneSource&, Problem& p) { p.contact.coefficient = 0.0; }),
      With("u₀ = 0", "no slip to have a direction", [](SceneSource&, Problem& p) { p.contact.u0 = 0.0; }),
      With("u₀ = ±10⁻³⁰⁰", "a direction and nothing else", [](SceneSource&, Problem& p) { p.contact.u0 *= 1e-300; }),
      With("v₀ = −10⁻³⁰⁰, u₀ = 0", "squares below the smallest double",
           [](SceneSource&, Problem& p) {
             p.contact.u0 = 0.0;
             p.contact.v0 = -1e-300;
           }),
      With("v₀ = −2⁻¹⁰⁷⁴, u₀ = 0", "one bit of velocity",
           [](SceneSource&, Problem& p) {
             p.contact.u0 = 0.0;
             p.contact.v0 = -0x1p-1074;
           }),
      With("W and velocities at 10^±250", "squares and products leave the range", OtherUnits),
      With(
          "ratio² from 10⁻⁶ to 10⁻³", "the rigid limit: hundreds of sections",
          [](SceneSource& source, Problem& p) { p.ratio_squared = source.LogUniform(1e-6, 1e-3); }, 5),
      With("μ from 10⁻³⁰⁰ to 10⁻¹²", "the limit of no friction",
           [](SceneSource& source, Problem& p) { p.contact.mu = source.LogUniform(1e-300, 1e-12); }),
      With("μ from 10 to 10³ Wnn/\\|Wtn\\|", "coupled oscillations all along, and friction that can push the body in",
           [](SceneSource& source, Problem& p) {
             p.contact.w.tn =
                 std::copysign(source.Uniform(0.1, 0.8) * std::sqrt(p.contact.w.tt * p.contact.w.nn), p.contact.w.tn);
             p.contact.mu = source.LogUniform(10.0, 1e3) * p.contact.w.nn / std::fabs(p.contact.w.tn);
           }),
      With("μ from 10⁶ to 10¹⁵, Wtn = 0", "the particle slips at the tip of the cone alone",
           [](SceneSource& source, Problem& p) {
             p.contact.w.tn = 0.0;
             p.contact.mu = source.LogUniform(1e6, 1e15);
           }),
  };
}

// The error of the energy lost to deformation, relative to that energy.
HardCaseResult RunLoss() {
  HardCaseResult result = {.name = "η = 1 − 2⁻ᵏ, k to 53: the loss", .why = "1 − η² is what deformation takes"};
  SceneSource source(32);
  for (int k = 1; k <= 53; ++k) {
    Problem problem = Everyday(source);
    problem.contact.coefficient = 1.0 - std::ldexp(1.0, -k);
    const ExactImpact exact = SolveExactly(problem);
    const PlanarReduction reduction = {.w = {problem.contact.w.tt, problem.contact.w.tn, problem.contact.w.nn},
                                       .u0 = {problem.contact.u0},
                                       .v0 = problem.contact.v0};
    const Outcome outcome =
        Made([&](Outcome& made) { return MakeOutcome(problem, reduction, {.numbers_only = true}, made); }).value();
    const auto error = [&exact](double loss) {
      return (Abs(Ball(loss, 192) - exact.work_normal) / Abs(exact.work_normal)).UpperBound();
    };
    result.promised = std::max(result.promised, outcome.accuracy.relative_error);
    result.seen = std::max(result.seen, error(outcome.work.normal_total_j));
    result.naive = std::max(result.naive, error(NaiveSolve(problem).work_normal));
  }
  return result;
}

// On everyday impacts the naive formulas serve: on the hard cases their arithmetic fails, not their path.
TEST(CompliantHardCasesTest, NaiveFormulasServeEverydayProblems) {
  SceneSource source(33);
  for (int i = 0; i < 60; ++i) {
    const Problem problem = Everyday(source);
    const double error = NaiveError(problem, SolveExactly(problem));
    EXPECT_NE(error, kOtherRegime) << ToString(problem);
    EXPECT_LE(error, 1e-9) << ToString(problem);
  }
}

TEST(CompliantHardCasesTest, KeepTheirPromise) {
  std::vector<HardCaseResult> results;
  for (const HardCase& hard : HardCases()) results.push_back(ResultOf(hard));
  results.push_back(RunLoss());
  CheckTable("compliant", "of max(\\|u₀\\|, \\|v₀\\|)", results);
}

}  // namespace
}  // namespace ricochet::compliant
