// The recipe of docs/your_robot.md for Simbody.

#include "tests/robots/simbody_recipe.h"

#include <gtest/gtest.h>

#include <array>

#include "ricochet/solver.h"
#include "tests/robots/rods.h"

namespace ricochet::robots {
namespace {

TEST(SimbodyRecipe, DoublePendulumIsTheLinkageAndTheClosedForm) {
  const Joints joints;
  const SimbodyMatrices matrices = DoublePendulumInSimbody(joints.angle.data(), joints.rate.data());
  // In the plane x y the first two rows are t and n.
  const Mechanism mechanism = {.mass_matrix = matrices.mass,
                               .jacobian = {matrices.jacobian.begin(), matrices.jacobian.begin() + 4},
                               .rates = matrices.rates};
  const auto solve = [](const System& system, double friction) {
    return LocalSolver()
        .Solve({.scene = {.system = system,
                          .friction = {.kinetic_coefficient = friction},
                          .restitution = NewtonCoefficient{0.5}}})
        ->outcome;
  };
  const Outcome rough = solve(mechanism, 0.3);
  const Outcome linkage = solve(Rods(joints), 0.3);
  EXPECT_NEAR(rough.rates_after[0], linkage.rates_after_rad_s[0], 1e-12);
  EXPECT_NEAR(rough.rates_after[0] + rough.rates_after[1], linkage.rates_after_rad_s[1], 1e-12);
  const Outcome smooth = solve(mechanism, 0.0);
  const std::array<double, 2> exact = RatesAfterFrictionlessImpact(joints, 0.5);
  EXPECT_NEAR(smooth.rates_after[0], exact[0], 1e-12);
  EXPECT_NEAR(smooth.rates_after[1], exact[1], 1e-12);
}

}  // namespace
}  // namespace ricochet::robots
