// Lubarda (2009) [40]-[42], [52]: works in proportion, and the energy lost told from impulses and velocities.

#include "core/models/pendulum/works.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/models/restitution_law.h"
#include "tests/support/pendulum_scenes.h"

namespace ricochet::pendulum {
namespace {

Problem PaperProblem(double eta) {
  return {.inertia = 1.0,
          .a = 5.0,
          .b = 3.0,
          .omega_minus = -1.0,
          .mu = 1.0,
          .mu_static = 1.0,
          .law = RestitutionLaw::kEnergetic,
          .coefficient = eta};
}

// x = 3/5, r = 1/4, eta = 1/2: by hand.
TEST(PendulumWorksTest, RatiosAtXThreeFifthsAreThoseWorkedByHand) {
  const WorkRatios ratios = SolveWorkRatios(PaperProblem(0.5));
  EXPECT_DOUBLE_EQ(ratios.normal, 0.25);
  EXPECT_DOUBLE_EQ(ratios.tangential, 0.25);
  EXPECT_DOUBLE_EQ(ratios.total, 1.0 / 16.0);
  EXPECT_DOUBLE_EQ(ratios.compression_coupling, 0.6);
  EXPECT_DOUBLE_EQ(ratios.tangential_to_normal, 0.6 * 1.25 / 0.75);
}

TEST(PendulumWorksTest, ElasticImpactHasNoNormalWorkToCompareWith) {
  EXPECT_EQ(SolveWorkRatios(PaperProblem(1.0)).tangential_to_normal, std::numeric_limits<double>::infinity());
}

TEST(PendulumWorksTest, SmoothImpactHasNoTangentialWork) {
  Problem problem = PaperProblem(0.5);
  problem.mu = problem.mu_static = 0.0;
  const WorkRatios ratios = SolveWorkRatios(problem);
  EXPECT_EQ(ratios.tangential, 0.0);
  EXPECT_EQ(ratios.tangential_to_normal, 0.0);
  EXPECT_DOUBLE_EQ(ratios.normal, 0.25);
}

TEST(PendulumWorksTest, LockedImpactReturnsNothing) {
  Problem problem = PaperProblem(0.5);
  problem.mu = problem.mu_static = 2.0;
  const WorkRatios ratios = SolveWorkRatios(problem);
  EXPECT_EQ(ratios.normal, 0.0);
  EXPECT_EQ(ratios.total, 0.0);
  EXPECT_DOUBLE_EQ(ratios.compression_coupling, 1.2);
  EXPECT_DOUBLE_EQ(ratios.tangential_to_normal, 1.2);
}

// The ratios against the works themselves, which other tests hold to exact values.
TEST(PendulumWorksTest, RatiosAreThoseOfTheWorks) {
  SceneSource source(7);
  for (int i = 0; i < 2000; ++i) {
    const Problem problem = source.Everyday();
    const Impact impact = Solve(problem);
    const WorkRatios ratios = SolveWorkRatios(problem);
    const double compression = impact[Output::kWorkNormalCompression] + impact[Output::kWorkTangentialCompression];
    const double restitution = impact[Output::kWorkNormalRestitution] + impact[Output::kWorkTangentialRestitution];
    EXPECT_NEAR(ratios.normal, -impact[Output::kWorkNormalRestitution] / impact[Output::kWorkNormalCompression],
                1e-14 * ratios.normal);
    // Wr is a difference of its two parts, so its rounding is that of the larger one.
    const double rounding = 4e-16 * impact[Output::kWorkNormalRestitution] / -compression;
    EXPECT_NEAR(ratios.total, -restitution / compression, 4e-15 * ratios.total + rounding);
  }
}

TEST(PendulumWorksTest, ThomsonTaitGivesTheEnergyLost) {
  const Problem problem = PaperProblem(0.5);
  const Impact impact = Solve(problem);
  const double loss = ThomsonTaitLoss(impact[Output::kTangentialImpulse], impact[Output::kNormalImpulse],
                                      problem.b * problem.omega_minus, impact[Output::kTangentialVelocityAfter],
                                      problem.a * problem.omega_minus, impact[Output::kNormalVelocityAfter]);
  EXPECT_DOUBLE_EQ(loss, 0.5 * (1.0 - 1.0 / 16.0));
  EXPECT_DOUBLE_EQ(loss, -impact[Output::kEnergyChange]);
}

}  // namespace
}  // namespace ricochet::pendulum
