// The exact velocities of a study agree with each other where two ways lead to one of them.

#include "core/cost/reference_velocity.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/certified/certified.h"
#include "core/models/planar/planar.h"
#include "tests/support/scenes/spatial_contact.h"

namespace ricochet {
namespace {

bool Never() { return false; }

// W = (1/J)(b^2, a b; a^2) and (u0, v0) = (b, a) omega- of this pendulum are exact doubles.
pendulum::Problem SomePendulum(RestitutionLaw law) {
  return {.inertia = 2.0,
          .a = 0.5,
          .b = 1.5,
          .omega_minus = -1.25,
          .mu = 0.1,
          .mu_static = 0.2,
          .law = law,
          .coefficient = 0.7};
}

planar::Problem ItsContact(RestitutionLaw law) {
  return {.w = {.tt = 1.125, .tn = 0.375, .nn = 0.125},
          .u0 = -1.875,
          .v0 = -0.625,
          .mu = 0.1,
          .mu_static = 0.2,
          .law = law,
          .coefficient = 0.7};
}

TEST(ReferenceVelocityTest, AContactOfRankOneMovesAsItsPendulum) {
  for (const RestitutionLaw law : {RestitutionLaw::kNewton, RestitutionLaw::kPoisson, RestitutionLaw::kEnergetic}) {
    const ReferenceVelocity pendulum = ExactRigid(SomePendulum(law), Never);
    EXPECT_LE(Distance(pendulum, ExactRigid(ItsContact(law), Never)), 1e-28);
    EXPECT_LE(Distance({pendulum::Solve(SomePendulum(law))[pendulum::Output::kTangentialVelocityAfter], 0.0,
                        pendulum::Solve(SomePendulum(law))[pendulum::Output::kNormalVelocityAfter]},
                       pendulum),
              0x1p-52);
  }
}

TEST(ReferenceVelocityTest, SlipThatGoesOnIsTheWholeImpact) {
  const planar::Problem problem = {
      .w = {2.0, 0.5, 1.0}, .u0 = 30.0, .v0 = -1.0, .mu = 0.3, .mu_static = 0.3, .coefficient = 0.6};
  const sliding::Problem<1> straight = {.w = {2.0, 0.5, 1.0}, .u0 = {30.0}, .v0 = -1.0, .mu = 0.3, .coefficient = 0.6};
  const ReferenceVelocity exact = ExactRigid(problem, Never);
  EXPECT_LE(Distance(ExactSliding(straight), exact), 1e-27);
  // Computed by hand: tau1 = 1.6/(1 - 0.3 * 0.5), u1 = 30 + (0.5 - 0.3 * 2) tau1.
  const Velocity3 rounded = RoundedVelocity(exact);
  EXPECT_NEAR(rounded[0], 30.0 - 0.1 * 1.6 / 0.85, 1e-14);
  EXPECT_NEAR(rounded[2], 0.6, 1e-16);
}

TEST(ReferenceVelocityTest, SpaceWithoutCouplingIsAPlane) {
  // Slip along t1 stays there, because nothing couples t2.
  const spatial::Problem problem =
      spatial::Contact({2.0, 0.0, 0.5, 2.0, 0.0, 1.0}, {1.0, 0.0}, -1.0, 0.5, {.coefficient = 0.6});
  const ReferenceVelocity space = ExactSpatial(problem);
  const ReferenceVelocity plane = ExactRigid(
      planar::Problem{.w = {2.0, 0.5, 1.0}, .u0 = 1.0, .v0 = -1.0, .mu = 0.5, .mu_static = 0.5, .coefficient = 0.6},
      Never);
  EXPECT_LE(std::fabs(RoundedVelocity(space)[0] - RoundedVelocity(plane)[0]), space.error + 0x1p-52);
  EXPECT_LE(std::fabs(RoundedVelocity(space)[2] - RoundedVelocity(plane)[2]), space.error + 0x1p-52);
  EXPECT_LE(space.error, 1e-13);
}

TEST(ReferenceVelocityTest, ALastBitIsSeen) {
  const ReferenceVelocity exact = ExactRigid(SomePendulum(RestitutionLaw::kEnergetic), Never);
  if (!certified::IsAvailable()) GTEST_SKIP() << "the component certified is left out";
  Velocity3 rounded = RoundedVelocity(exact);
  const double nearest = Distance(rounded, exact);
  rounded[0] = std::nextafter(rounded[0], 2.0);
  EXPECT_LE(nearest, 0x1p-54);
  EXPECT_GT(nearest, 0.0);
  EXPECT_GT(Distance(rounded, exact), 0x1p-55);
}

}  // namespace
}  // namespace ricochet
