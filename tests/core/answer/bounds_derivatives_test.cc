// Derivatives of bounds against the derivatives of the paper's formulas, against exact derivatives of the impacts that
// reach the ends, and their refusals.

#include "core/answer/bounds_derivatives.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "core/answer/derivative_paths.h"
#include "core/answer/derivatives.h"
#include "core/answer/exact_derivatives.h"
#include "core/scene/validate.h"
#include "ricochet/solver.h"
#include "tests/support/scenes/random_scenes.h"

namespace ricochet {
namespace {

using testing::ElementsAre;
using testing::Field;
using testing::HasSubstr;

constexpr char kMu[] = "friction.kinetic_coefficient";

BoundsResponse Asked(const Scene& scene, const DerivativePaths& paths) {
  const LocalSolver solver;
  const auto response = solver.Bounds({.scene = scene, .derivatives = paths});
  EXPECT_TRUE(response.ok()) << response.status();
  return response.ok() ? *response : BoundsResponse();
}

Derivative Only(const Scene& scene, const std::string& of, const std::string& by) {
  const BoundsResponse response = Asked(scene, {.of = {of}, .by = {by}});
  return response.derivatives.empty() ? Derivative() : response.derivatives.front();
}

Scene PendulumWith(double mu) {
  return {.system = Pendulum{.inertia_kg_m2 = 2.0, .a_m = 0.3, .b_m = 1.0, .omega_minus_rad_s = -1.5},
          .friction = {.kinetic_coefficient = mu}};
}

TEST(BoundsDerivativesTest, PendulumHasThoseOfThePapersFormulas) {
  constexpr double kA = 0.3, kB = 1.0, kFriction = 0.12, kX = kFriction * kB / kA, kXByMu = kB / kA;
  const Scene scene = PendulumWith(kFriction);
  const double root = std::sqrt((1.0 - kX) / (1.0 + kX));
  const auto by_mu = [&](const char* of, double expected) {
    const Derivative found = Only(scene, of, kMu);
    ASSERT_TRUE(found.value.has_value()) << of << ": " << found.reason;
    EXPECT_NEAR(*found.value / expected, 1.0, 1e-10) << of;
    EXPECT_GE(*found.error, std::fabs(*found.value - expected)) << of;
  };
  by_mu("sharp.newton.upper", -kXByMu / ((1.0 + kX) * (1.0 + kX) * root));                    // [29]
  by_mu("sharp.poisson.upper", kXByMu / ((1.0 + kX) * (1.0 + kX) * root * root * root));      // [30]
  by_mu("energy_only.poisson.upper", 2.0 * kXByMu / ((1.0 - kX) * (1.0 - kX)));               // [28]
  by_mu("sharp.tangential.lower", -kX / std::sqrt(1.0 - kX * kX));                            // [55]
  by_mu("sharp.tangential.upper", 1.0);                                                       // [55]
  EXPECT_NEAR(*Only(scene, "critical.stick", "pendulum.b_m").value, -kA / (kB * kB), 1e-11);  // a/|b|
  const Derivative impulse = Only(scene, "sharp.normal_total_n_s.upper", "pendulum.inertia_kg_m2");
  EXPECT_NEAR(*impulse.value, (1.0 + 1.0 / root) * 1.5 / (kA + kFriction * kB), 1e-9);  // [31]
}

TEST(BoundsDerivativesTest, FrictionThatLocksAPendulumHasOneSide) {
  // Newton's bound falls to 0 as sqrt(1 - x), infinitely fast, and stays there.
  const Derivative found = Only(PendulumWith(0.3), "sharp.newton.upper", kMu);
  EXPECT_EQ(found.kind, DerivativeKind::kOneSided);
  EXPECT_FALSE(found.from_below.has_value());
  EXPECT_EQ(found.from_above, 0.0);
}

// The ends of a range are coefficients of the plastic and of the elastic impact.
TEST(BoundsDerivativesTest, EndsInAPlaneMoveAsTheImpactsThatReachThem) {
  RandomScenes random(71);
  int compared = 0;
  for (int i = 0; i < 200; ++i) {
    const auto uniform = [&random](double low, double high) { return random.Uniform(low, high); };
    Scene scene = {.system = PlanarContact{uniform(1.0, 4.0), uniform(-1.0, 1.0), uniform(1.0, 4.0), uniform(-2.0, 2.0),
                                           uniform(-2.0, -0.5)},
                   .friction = {.kinetic_coefficient = uniform(0.05, 1.0)}};
    const std::vector<std::string> by = {kMu, "planar_contact.tangential_m_s", "planar_contact.w_tn_per_kg"};
    const BoundsResponse bounds =
        Asked(scene, {.of = {"sharp.newton.upper", "sharp.normal_total_n_s.upper"}, .by = by});
    scene.restitution = EnergeticCoefficient{1.0};
    const std::vector<Derivative> elastic =
        ExactDerivativesOf(scene, {.of = {"coefficients.newton", "impulse.normal_total_n_s"}, .by = by});
    ASSERT_EQ(bounds.derivatives.size(), elastic.size());
    for (size_t k = 0; k < elastic.size(); ++k) {
      const Derivative& found = bounds.derivatives[k];
      if (!elastic[k].value.has_value() || !found.value.has_value()) continue;
      ++compared;
      EXPECT_NEAR(*found.value, *elastic[k].value, *found.error + 1e-12 * std::fabs(*elastic[k].value))
          << found.of << " by " << found.by << ", scene " << i;
      EXPECT_LE(*found.error, 1e-7 * (1.0 + std::fabs(*found.value)));
    }
  }
  EXPECT_GT(compared, 1100);
}

// Where slip stops just before or behind the end that energy allows; values of 50 digits.
TEST(BoundsDerivativesTest, AKinkNearbyIsNotSteppedOver) {
  struct Case {
    PlanarContact contact;
    double mu;
    std::string of, by;
    double exact;
  };
  const PlanarContact steep = {6.449005946682667, -4.1749519537457, 4.185789901407973, -3.6365151494193984,
                               -1.4513833641155771};
  const PlanarContact level = {0.4403488839787537, 0.0, 0.6114968693899864, -0.049550688638391314,
                               -0.48491453947146557};
  for (const Case& one :
       std::vector<Case>{{steep, 0.7520194099090497, "energy_only.normal_total_n_s.upper", kMu, 0.0},
                         {steep, 0.7520194099090497, "energy_only.poisson.upper", kMu, -15.5011370144},
                         {level, 0.07069456606304128, "energy_only.normal_total_n_s.upper",
                          "planar_contact.w_tn_per_kg", -0.36671473269082244}}) {
    const Scene scene = {.system = one.contact, .friction = {.kinetic_coefficient = one.mu}};
    const Derivative found = Only(scene, one.of, one.by);
    ASSERT_TRUE(found.value.has_value()) << one.of << ": " << found.reason;
    EXPECT_NEAR(*found.value, one.exact, *found.error + 1e-10) << one.of;
    EXPECT_LT(*found.error, 1e-4) << one.of;
  }
}

// critical.stick does not depend on friction, nor does the largest energetic coefficient, 1.
TEST(BoundsDerivativesTest, AThresholdNearbyIsNone) {
  for (int power = 20; power < 43; ++power) {
    const double distance = std::ldexp(1.0, -power);
    for (const double sign : {-1.0, 1.0}) {
      const Scene scene = {.system = PlanarContact{1.0, 0.0, 1.0, 0.5 * (1.0 + sign * distance), -1.0},
                           .friction = {.kinetic_coefficient = 0.5}};
      for (const char* const of : {"critical.stick", "sharp.energetic.upper"}) {
        const Derivative found = Only(scene, of, kMu);
        EXPECT_EQ(found.kind, DerivativeKind::kTwoSided) << of << ", " << sign * distance << ": " << found.reason;
        EXPECT_EQ(found.value.value_or(1.0), 0.0) << of;
      }
    }
  }
}

TEST(BoundsDerivativesTest, ImpulseOfABallInSpaceFollowsItsSpeed) {
  const Scene scene = {.system = SpatialContact{{1.0, 0.0, 0.0, 1.0, 0.0, 0.5}, {0.3, 0.4}, -2.0},
                       .friction = {.kinetic_coefficient = 0.1}};
  const Derivative found = Only(scene, "sharp.normal_total_n_s.upper", "spatial_contact.normal_m_s");
  EXPECT_NEAR(*found.value, -2.0 / 0.5, 1e-6);  // (1 + 1) |v0| / W33
}

TEST(BoundsDerivativesTest, WrongPathsAreNamed) {
  const Scene space = {.system = SpatialContact{{1.0, 0.0, 0.0, 1.0, 0.0, 0.5}, {0.3, 0.4}, -2.0}};
  const DerivativePaths paths = {.of = {"critical.stick", "sharp.newton.uper"}, .by = {"restitution.energetic"}};
  const std::vector<Violation> violations = CheckBoundsDerivatives(space, paths);
  EXPECT_THAT(violations, ElementsAre(Field(&Violation::field, "derivatives.of[0]"),
                                      Field(&Violation::rule, HasSubstr("sharp.newton.upper")),
                                      Field(&Violation::field, "derivatives.by[0]")));
  EXPECT_THAT(CheckBoundsDerivatives(space, {}),
              ElementsAre(Field(&Violation::field, "derivatives.of"), Field(&Violation::field, "derivatives.by")));
}

}  // namespace
}  // namespace ricochet
