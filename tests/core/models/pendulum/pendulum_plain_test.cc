// The kernel in plain arithmetic, compared with the paper's formulas in ball arithmetic: it never errs by more than it
// claims, and never claims a sign that it cannot prove.

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <vector>

#include "core/models/pendulum/pendulum.h"
#include "tests/support/claims/pendulum_claims.h"
#include "tests/support/oracles/pendulum_oracle.h"
#include "tests/support/scenes/pendulum_scenes.h"

namespace ricochet::pendulum {
namespace {

struct Claims {
  int proved = 0;
  std::vector<double> claimed_over_achieved;

  void Check(const Problem& problem) {
    const PlainImpact plain = SolvePlain(problem);
    if (!plain.proved) return;
    ++proved;
    const double achieved = AchievedError(problem, plain.impact, SolveExactly(problem));
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
