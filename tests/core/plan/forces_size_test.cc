// The change by finite forces never exceeds their size; a spring alone changes nothing.

#include <gtest/gtest.h>

#include <cmath>

#include "core/models/finite_duration/finite_duration.h"
#include "core/models/planar/planar.h"
#include "core/plan/contact_time.h"
#include "core/plan/sizes.h"
#include "tests/support/claims/impact_change.h"
#include "tests/support/claims/impact_tally.h"
#include "tests/support/scenes/plan_scenes.h"

namespace ricochet {
namespace {

constexpr int kScenes = 300;
constexpr double kTolerance = 1e-11;

struct Forced {
  planar::Problem problem;
  ContactPhysics physics;
};

Forced Scene(PlanScenes& scenes) {
  Forced scene = {.problem = scenes.ForSprings()};
  scene.problem.coefficient = scenes.Uniform(0.1, 1.0);
  const double stiffness = scenes.Power(3.0, 9.0);
  if (scenes.Below(2) == 0) {
    scene.physics.spring = LinearSpring{.stiffness_n_m = stiffness};
  } else {
    scene.physics.spring = HertzSpring{.stiffness_n_m1_5 = stiffness};
  }
  scene.physics.tangential_acceleration = scenes.Below(3) == 0 ? 0.0 : scenes.Sign() * scenes.Power(-4.0, 2.0);
  scene.physics.normal_acceleration = scenes.Sign() * scenes.Power(-4.0, 2.0);
  return scene;
}

finite_duration::Problem TimedOf(const Forced& scene) {
  const auto& [problem, physics] = scene;
  return {.contact = problem,
          .tangential_acceleration = physics.tangential_acceleration,
          .normal_acceleration = physics.normal_acceleration,
          .spring = physics.spring,
          .tolerance = kTolerance};
}

TEST(ForcesSizeTest, OfFiniteForces) {
  PlanScenes scenes(21);
  ImpactTally kept("finite forces");
  ImpactTally smooth("finite forces and friction");
  for (int i = 0; i < kScenes; ++i) {
    const Forced scene = Scene(scenes);
    const finite_duration::Impact with = finite_duration::Solve(TimedOf(scene));
    const Sizes sizes = PlanarSizes(scene.problem, scene.physics);
    const double noise = std::max(with.error_estimate, kTolerance);
    const double tolerance = scenes.Power(-6.0, -1.0);
    kept.Add(OverSpeed(sizes[Effect::kFiniteForces], scene.problem),
             ChangeBetween(scene.problem, EndingOf(with), EndingOf(planar::Solve(scene.problem))), noise, tolerance);
    Size both = sizes[Effect::kFriction];
    both.value += sizes.forces_beyond_friction;
    smooth.Add(OverSpeed(both, scene.problem),
               ChangeBetween(scene.problem, EndingOf(with), EndingOf(planar::Solve(Smooth(scene.problem)))), noise,
               tolerance);
  }
  kept.Finish(30);
  smooth.Finish(15);
}

TEST(ForcesSizeTest, ContactLastsNoLongerThanItsBound) {
  PlanScenes scenes(22);
  int sharp = 0;
  int bounded = 0;
  for (int i = 0; i < kScenes; ++i) {
    const Forced scene = Scene(scenes);
    const double cone = scene.problem.mu * std::fabs(scene.problem.w.tn);
    const double longest =
        LongestContact(scene.physics.spring, {.slope_low = scene.problem.w.nn - cone,
                                              .slope_high = scene.problem.w.nn + cone,
                                              .v0 = scene.problem.v0,
                                              .energetic = scene.problem.coefficient,
                                              .acceleration = std::fabs(scene.physics.normal_acceleration)});
    if (!std::isfinite(longest)) continue;
    const double time = finite_duration::Solve(TimedOf(scene)).contact.duration_s;
    ++bounded;
    EXPECT_LE(time, longest * (1.0 + 1e-6));
    if (cone < 0.1 * scene.problem.w.nn) sharp += time > 0.5 * longest ? 1 : 0;
  }
  EXPECT_GT(bounded, kScenes / 2);
  EXPECT_GT(sharp, bounded / 4);
}

TEST(ForcesSizeTest, ASpringAloneChangesNothing) {
  PlanScenes scenes(23);
  for (int i = 0; i < kScenes / 2; ++i) {
    Forced scene = Scene(scenes);
    scene.physics.tangential_acceleration = scene.physics.normal_acceleration = 0.0;
    const finite_duration::Impact with = finite_duration::Solve(TimedOf(scene));
    const Sizes sizes = PlanarSizes(scene.problem, scene.physics);
    EXPECT_EQ(sizes[Effect::kFiniteDuration].value, 0.0);
    EXPECT_EQ(sizes[Effect::kFiniteDuration].basis, Basis::kSameImpulses);
    EXPECT_LE(ChangeBetween(scene.problem, EndingOf(with), EndingOf(planar::Solve(scene.problem))),
              10.0 * std::max(with.error_estimate, kTolerance));
  }
}

}  // namespace
}  // namespace ricochet
