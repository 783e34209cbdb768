// The compliant model against its equations in time, by Taylor series at 58 digits.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "core/models/compliant/compliant.h"
#include "tests/support/oracles/arb.h"
#include "tests/support/oracles/compliant_oracle.h"
#include "tests/support/scenes/compliant_scenes.h"
#include "tests/support/scenes/vectors.h"

namespace ricochet::compliant {
namespace {

bool SameModes(const Impact& impact, const ExactImpact& exact) {
  const auto same = [](const Section& a, const Section& b) {
    return a.friction == b.friction && a.first_loading == b.first_loading && a.indenting == b.indenting;
  };
  return std::equal(impact.sections.begin(), impact.sections.end(), exact.sections.begin(), exact.sections.end(), same);
}

// Two programs that know nothing of each other. The file has 25 digits.
TEST(CompliantArbTest, TheOracleHasTheDigitsOfTheTable) {
  struct Column {
    const char* name;
    const Ball ExactImpact::*value;
  };
  constexpr Column kColumns[] = {{"u1", &ExactImpact::u1},
                                 {"v1", &ExactImpact::v1},
                                 {"tau_compression", &ExactImpact::tau_compression},
                                 {"tau1", &ExactImpact::tau1},
                                 {"friction_impulse", &ExactImpact::f1},
                                 {"work_n_compression", &ExactImpact::work_normal_compression},
                                 {"work_n_restitution", &ExactImpact::work_normal_restitution}};
  const Ball digits = Ball::Parse("3e-24", 192);
  for (const VectorRow& row : ReadVectors("compliant.csv")) {
    const ExactImpact exact = SolveExactly(ProblemOf(row));
    ASSERT_TRUE(exact.ends);
    for (const Column& column : kColumns) {
      const Ball given = Ball::Parse(row.at(column.name), 192);
      EXPECT_LE(Abs(exact.*column.value - given), digits * Abs(given)) << row.at("modes") << " " << column.name;
    }
    const Ball tangential = -(exact.friction_dissipation + exact.spring_energy);
    const Ball given = Ball::Parse(row.at("work_t"), 192);
    EXPECT_LE(Abs(tangential - given), digits * (Abs(given) + Abs(exact.work_normal_compression)));
  }
}

TEST(CompliantArbTest, TheOracleHasTheSameDigitsAtTwiceThePrecision) {
  SceneSource scenes(21);
  const Ball digits = Ball::Parse("1e-40", 384);
  for (int i = 0; i < 30; ++i) {
    const Problem problem = scenes.Everyday(0.02, 50.0);
    const ExactImpact exact = SolveExactly(problem);
    const ExactImpact peer = SolveExactly(problem, 384);
    const Ball speed(std::max(std::fabs(problem.contact.u0), std::fabs(problem.contact.v0)), 384);
    ASSERT_TRUE(exact.ends && peer.ends) << ToString(problem);
    ASSERT_EQ(exact.sections.size(), peer.sections.size()) << ToString(problem);
    EXPECT_LE(Abs(exact.u1 - peer.u1), digits * speed) << ToString(problem);
    EXPECT_LE(Abs(exact.v1 - peer.v1), digits * speed) << ToString(problem);
    EXPECT_LE(Abs(exact.friction_dissipation - peer.friction_dissipation),
              digits * Abs(exact.work_normal_compression) + digits * Abs(peer.friction_dissipation))
        << ToString(problem);
  }
}

class Comparison {
 public:
  void Add(const Problem& problem) {
    const ExactImpact exact = SolveExactly(problem);
    const Impact impact = Solve(problem);
    ASSERT_TRUE(exact.ends) << ToString(problem);
    ASSERT_EQ(impact.regime, exact.regime) << ToString(problem);
    ASSERT_TRUE(SameModes(impact, exact)) << ToString(problem);
    const double error = VelocityError(problem, impact.u1, impact.v1, exact);
    ASSERT_LE(error, impact.error_estimate) << ToString(problem);
    worst_ = std::max(worst_, error);
    // The energy moved: what compression took in and what friction took away.
    const Ball moved = Abs(exact.work_normal_compression) + exact.friction_dissipation;
    const Ball allowance = Ball(16.0 * impact.error_estimate) * moved;
    const auto near = [&](double computed, const Ball& value) { return Abs(Ball(computed, 192) - value) <= allowance; };
    ASSERT_TRUE(near(impact.friction_dissipation, exact.friction_dissipation)) << ToString(problem);
    ASSERT_TRUE(near(impact.work_normal_compression, exact.work_normal_compression)) << ToString(problem);
    ASSERT_TRUE(near(impact.work_normal_restitution, exact.work_normal_restitution)) << ToString(problem);
  }
  double worst() const { return worst_; }

 private:
  double worst_ = 0.0;
};

TEST(CompliantArbTest, EveryImpactHasTheModesOfTheOracleAndAnErrorBelowItsEstimate) {
  SceneSource scenes(22);
  Comparison comparison;
  for (int i = 0; i < 200 && !testing::Test::HasFatalFailure(); ++i) comparison.Add(scenes.Everyday(1e-3, 1e3));
  std::printf("  worst error %.2e\n", comparison.worst());
}

// The doubles next to mu ratio^2 |v0|, a product of three.
TEST(CompliantArbTest, TheStartIsAStickOrASlideByTheExactSign) {
  SceneSource scenes(23);
  int close = 0;
  for (int i = 0; i < 10'000; ++i) {
    Problem problem = scenes.Everyday(0.02, 50.0);
    const double product = problem.contact.mu * problem.ratio_squared * -problem.contact.v0;
    const Ball exact = Ball(problem.contact.mu, Ball::kExact) * Ball(problem.ratio_squared) * -Ball(problem.contact.v0);
    if ((exact - Ball(product)).ContainsZero()) continue;
    problem.contact.u0 = product;
    const bool sticks = Ball(problem.contact.u0, Ball::kExact) < exact;
    ASSERT_EQ(Solve(problem).sections.front().friction, sticks ? FrictionState::kStick : FrictionState::kSlideForward)
        << ToString(problem);
    ++close;
  }
  EXPECT_GT(close, 9'000);
}

// A velocity that has few bits left is no better than its rounding.
TEST(CompliantArbTest, TheEstimateCoversTheRoundingOfSubnormalVelocities) {
  SceneSource scenes(24);
  for (int i = 0; i < 60; ++i) {
    Problem problem = scenes.Everyday(0.1, 4.0);
    problem.contact.u0 = std::scalbn(problem.contact.u0, -1060);
    problem.contact.v0 = std::scalbn(problem.contact.v0, -1060) - 0x1p-1074;
    const Impact impact = Solve(problem);
    EXPECT_LE(VelocityError(problem, impact.u1, impact.v1, SolveExactly(problem)), impact.error_estimate) << i;
  }
}

}  // namespace
}  // namespace ricochet::compliant
