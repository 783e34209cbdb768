// The kernel in plain arithmetic, compared with the paper's formulas in ball arithmetic: it never errs by more than it
// claims, and never claims a sign that it cannot prove.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <vector>

#include "core/models/pendulum/pendulum.h"
#include "tests/support/pendulum_oracle.h"
#include "tests/support/pendulum_scenes.h"

namespace ricochet::pendulum {
namespace {

// The scale of an output's error, as PlainImpact in core/models/pendulum/pendulum.h defines it.
Ball ScaleOf(const Problem& problem, const ExactImpact& exact, Output output) {
  const Ball inertia(problem.inertia, 128);
  const Ball a(problem.a, 128);
  const Ball b(std::fabs(problem.b), 128);
  Ball omega(std::fabs(problem.omega_minus), 128);
  Ball velocity = (problem.a > std::fabs(problem.b) ? a : b) * omega;
  const Ball& eta = exact[Output::kEnergetic];
  const Ball least = Ball::PowerOfTwo(-700);
  switch (output) {
    case Output::kNewton:
    case Output::kPoisson:
    case Output::kEnergetic:
      return exact[output] < least ? least : exact[output];
    case Output::kTangentialCoefficient:
      return Ball(problem.mu) < least ? least : Ball(problem.mu);
    case Output::kOmegaPlus:
      return omega;
    case Output::kTangentialVelocityAfter:
    case Output::kNormalVelocityAfter:
      return velocity;
    case Output::kNormalImpulseCompression:
    case Output::kNormalImpulse:
      return velocity * inertia / (a * a);
    case Output::kTangentialImpulse:
    case Output::kTangentialImpulseCompression:
      return problem.b == 0.0 ? Ball(0.0) : velocity * inertia / (b * b);
    case Output::kWorkNormalCompression:
    case Output::kWorkNormalRestitution:
    case Output::kWorkTangentialCompression:
    case Output::kWorkTangentialRestitution:
    case Output::kWorkNormal:
    case Output::kWorkTangential:
    case Output::kEnergyChange:
      return 0.5 * inertia * omega * omega * (1.0 + eta * eta);
    case Output::kEnergeticExcess:
      return 1.0 + eta;
  }
  return Ball(0.0);
}

// The largest error of an output over its scale. An output whose scale is 0 has to be exact.
double AchievedError(const Problem& problem, const Impact& impact) {
  const ExactImpact exact = SolveExactly(problem);
  EXPECT_EQ(impact.regime, exact.regime) << ToString(problem);
  EXPECT_EQ(impact.sharp_limit_broken, exact.sharp_limit_broken) << ToString(problem);
  EXPECT_EQ(impact.energy_limit_broken, exact.energy_limit_broken) << ToString(problem);
  double worst = 0.0;
  if (exact.regime == Regime::kSeparating) return worst;  // A test of its own covers it.
  for (int i = 0; i < kOutputCount; ++i) {
    const auto output = static_cast<Output>(i);
    const Ball error = Abs(Ball(impact[output], 256) - exact[output]);
    if (error.IsExact() && error.ContainsZero()) continue;
    const double relative = (error / ScaleOf(problem, exact, output)).UpperBound();
    EXPECT_FALSE(std::isnan(relative)) << OutputNames()[static_cast<size_t>(i)] << " at " << ToString(problem);
    worst = std::max(worst, relative);
  }
  return worst;
}

struct Claims {
  int proved = 0;
  std::vector<double> claimed_over_achieved;

  void Check(const Problem& problem) {
    const PlainImpact plain = SolvePlain(problem);
    if (!plain.proved) return;
    ++proved;
    const double achieved = AchievedError(problem, plain.impact);
    EXPECT_LE(achieved, plain.relative_error) << ToString(problem);
    if (achieved > 0.0) claimed_over_achieved.push_back(plain.relative_error / achieved);
  }

  double Median() {
    std::sort(claimed_over_achieved.begin(), claimed_over_achieved.end());
    return claimed_over_achieved[claimed_over_achieved.size() / 2];
  }

  void Print(const char* scenes) {
    std::printf("  %s: %d proved; claimed over achieved: least %.2f, median %.2f, most %.3g\n", scenes, proved,
                claimed_over_achieved.front(), Median(), claimed_over_achieved.back());
  }
};

TEST(PendulumPlainTest, ClaimsNoLessThanItErrsIn10000TypicalScenes) {
  SceneSource source(1);
  Claims claims;
  for (int i = 0; i < 10'000 && !HasFailure(); ++i) claims.Check(source.Everyday());  // A quarter of them locks.
  EXPECT_LE(claims.Median(), 15.0);
  EXPECT_GT(claims.proved, 9'900);
  claims.Print("typical");
}

// Sizes at and beyond the ends of the range that plain arithmetic serves, and numbers that are almost 0.
Problem OfExtremeSize(SceneSource& source, Problem problem) {
  const auto scale = [&source] { return std::exp2(source.Sign() * source.Uniform(90.0, 101.0)); };
  problem.inertia *= scale();
  problem.omega_minus *= scale();
  if (source.Sign() > 0.0) {
    const double lengths = scale();
    problem.a *= lengths;
    problem.b *= lengths;
  }
  if (source.Sign() > 0.0) problem.coefficient *= std::exp2(-source.Uniform(0.0, 1074.0));
  if (source.Sign() > 0.0) problem.b *= std::exp2(-source.Uniform(0.0, 1074.0));
  if (source.Sign() > 0.0) problem.mu *= std::exp2(-source.Uniform(0.0, 1074.0));
  return problem;
}

// Near every threshold, and at scales of 10^+-100.
Problem HardScene(SceneSource& source, int i) {
  if (i % 2 == 0) return source.Any();
  const Problem problem = source.NearSignChange(static_cast<SceneSource::SignChange>(i / 2 % SceneSource::kSignChanges),
                                                source.NearlyOne());
  return i % 3 == 0 ? OfExtremeSize(source, problem) : problem;
}

TEST(PendulumPlainTest, ClaimsNoLessThanItErrsIn20000HardScenes) {
  SceneSource source(2);
  Claims claims;
  for (int i = 0; i < 20'000 && !HasFailure(); ++i) claims.Check(HardScene(source, i));
  EXPECT_GT(claims.proved, 10'000);
  claims.Median();
  claims.Print("hard");
}

TEST(PendulumPlainTest, ServesNumbersWhoseProductsStayInRange) {
  const Problem problem = {
      .inertia = 1.0, .a = 0.3, .b = 1.0, .omega_minus = -2.0, .mu = 0.1, .mu_static = 0.1, .coefficient = 0.5};
  EXPECT_TRUE(SolvePlain(problem).proved);
  const auto scaled = [&problem](double Problem::*number, double size) {
    Problem other = problem;
    other.*number *= size;
    other.mu_static = std::max(other.mu, other.mu_static);
    return other;
  };
  for (double Problem::*number : {&Problem::inertia, &Problem::a, &Problem::omega_minus}) {
    for (const double size : {1e-100, 1e100}) EXPECT_FALSE(SolvePlain(scaled(number, size)).proved);
  }
  for (double Problem::*number : {&Problem::b, &Problem::mu}) {
    EXPECT_TRUE(SolvePlain(scaled(number, 1e-100)).proved);
    EXPECT_FALSE(SolvePlain(scaled(number, 1e100)).proved);
  }
}

TEST(PendulumPlainTest, TheBoundGrowsWithKappaAlone) {
  Problem problem = {
      .inertia = 1.0, .a = 1.0, .b = 1.0, .omega_minus = -2.0, .mu = 0.6, .mu_static = 0.6, .coefficient = 0.0};
  EXPECT_DOUBLE_EQ(SolvePlain(problem).relative_error, 15.0 * 0x1p-53);
  problem.coefficient = 1.0;  // kappa = sqrt(1.6/0.4) = 2
  EXPECT_DOUBLE_EQ(SolvePlain(problem).relative_error, 40.0 * 0x1p-53);
}

TEST(PendulumPlainTest, AContactThatSeparatesKeepsItsVelocities) {
  const Problem problem = {.inertia = 1.0, .a = 0.3, .b = 0.7, .omega_minus = 2.0, .coefficient = 0.5};
  const PlainImpact plain = SolvePlain(problem);
  EXPECT_TRUE(plain.proved);
  EXPECT_EQ(plain.impact.regime, Regime::kSeparating);
  EXPECT_EQ(plain.impact[Output::kOmegaPlus], 2.0);
  EXPECT_LE(plain.relative_error, 0x1p-53);
}

}  // namespace
}  // namespace ricochet::pendulum
