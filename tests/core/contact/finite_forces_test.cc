// The accelerations of a contact by finite forces alone, compared with values by hand and with the potential of
// gravity.

#include "core/contact/finite_forces.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstddef>

#include "tests/support/scenes/system_scenes.h"

namespace ricochet {
namespace {

using testing::DoubleEq;
using testing::ElementsAre;
using testing::IsEmpty;

constexpr double kG = 9.81;

PlanarReduction Under(const FiniteForces& forces, const System& system) {
  return std::get<PlanarReduction>(Reduce({.system = system, .finite_forces = forces}));
}

// The potential of gravity (g_t, g_n) for the chain, whose centres of mass hang from the pin.
double Potential(const Linkage& linkage, const Gravity& gravity) {
  double potential = 0.0;
  double t = 0.0;
  double n = 0.0;
  for (const Link& link : linkage.links) {
    const double along_t = std::sin(link.theta_rad);
    const double along_n = -std::cos(link.theta_rad);
    potential -= link.mass_kg * (gravity.tangential_m_s2 * (t + link.com_m * along_t) +
                                 gravity.normal_m_s2 * (n + link.com_m * along_n));
    t += link.length_m * along_t;
    n += link.length_m * along_n;
  }
  return potential;
}

TEST(FiniteForcesTest, AMomentTurnsAPendulumByHand) {
  const PlanarReduction reduction = Under(PinMoment{-4.0}, Pendulum{2.0, 0.5, 3.0, -1.0});
  EXPECT_THAT(reduction.drift, ElementsAre(-2.0));
  EXPECT_THAT(reduction.acceleration, ElementsAre(-6.0, -1.0));
  EXPECT_THAT(reduction.After({0.0}, 0.0, 0.25), ElementsAre(-1.5));
}

TEST(FiniteForcesTest, ABodyFallsAndAPairFallsTogether) {
  const PlanarReduction one = Under(Gravity{0.5, -kG}, Flat());
  EXPECT_THAT(one.acceleration, ElementsAre(0.5, -kG));
  EXPECT_THAT(one.drift, ElementsAre(0.5, -kG, 0.0));
  const PlanarReduction two = Under(Gravity{0.5, -kG}, BodyPair{PlanarPair{Flat(), Flat()}});
  EXPECT_THAT(two.acceleration, ElementsAre(0.0, 0.0));
  EXPECT_THAT(two.drift, ElementsAre(0.5, -kG, 0.0, 0.5, -kG, 0.0));
}

TEST(FiniteForcesTest, AContactTakesItsAccelerationAsItIs) {
  const PlanarReduction reduction = Under(ContactAcceleration{3.0, -7.0}, Contact());
  EXPECT_THAT(reduction.acceleration, ElementsAre(3.0, -7.0));
  EXPECT_THAT(reduction.drift, IsEmpty());
}

// J0 = m L^2/3, moment -m g (L/2) sin(theta).
TEST(FiniteForcesTest, AHangingRodSwingsByHand) {
  const double length = 0.8;
  const double theta = 0.4;
  const Link rod = {length, 3.0, 0.5 * length, 3.0 * length * length / 12.0, theta, -1.0};
  const PlanarReduction reduction = Under(Gravity{0.0, -kG}, Linkage{{rod}});
  const double turn = -1.5 * kG / length * std::sin(theta);
  EXPECT_THAT(reduction.drift, ElementsAre(DoubleEq(turn)));
  EXPECT_THAT(reduction.acceleration,
              ElementsAre(DoubleEq(length * std::cos(theta) * turn), DoubleEq(length * std::sin(theta) * turn)));
}

// a = J M^-1 Q = (M^-1 J^T)^T Q, where Q is computed from differences of the potential.
TEST(FiniteForcesTest, AChainsContactAcceleratesAsItsPotentialSays) {
  const Linkage chain = {
      {{1.2, 0.7, 0.4, 0.05, 0.3, -1.0}, {0.9, 1.5, -0.2, 0.1, -0.8, 0.5}, {0.5, 0.4, 0.6, 0.02, 2.0, 0}}};
  const Gravity gravity = {1.5, -kG};
  const PlanarReduction reduction = Under(gravity, chain);
  const double step = 1e-5;
  std::array<double, 2> expected = {};
  for (size_t i = 0; i < chain.links.size(); ++i) {
    Linkage ahead = chain;
    Linkage behind = chain;
    ahead.links[i].theta_rad += step;
    behind.links[i].theta_rad -= step;
    const double moment = -(Potential(ahead, gravity) - Potential(behind, gravity)) / (2.0 * step);
    expected[0] += reduction.response[2 * i] * moment;
    expected[1] += reduction.response[2 * i + 1] * moment;
  }
  EXPECT_NEAR(reduction.acceleration[0], expected[0], 1e-8 * kG);
  EXPECT_NEAR(reduction.acceleration[1], expected[1], 1e-8 * kG);
}

TEST(FiniteForcesTest, WithoutAnyNothingDrifts) {
  for (const System& system : {System(Flat()), System(Chain()), System(Contact())}) {
    const PlanarReduction reduction = Under(std::monostate(), system);
    EXPECT_THAT(reduction.drift, IsEmpty());
    EXPECT_THAT(reduction.acceleration, ElementsAre(0.0, 0.0));
    EXPECT_EQ(reduction.After({0.5}, 1.0, 100.0), reduction.After({0.5}, 1.0));
  }
}

}  // namespace
}  // namespace ricochet
