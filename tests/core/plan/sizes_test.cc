// Each inequality by itself: the true change never exceeds it, and it is not vacuous.
//
// The true change is the difference between two exact impacts, with the effect and without it. An inequality is not
// vacuous if it allows the effect to be left out of at least 90 % of the scenes whose true change is below a hundredth
// of a random tolerance. This is counted once over all scenes, and once over those in which the effect is not absent by
// proof. Static friction is not bounded sharply if it has an effect, because no model is cheaper without it.

#include "core/plan/sizes.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/models/pendulum/first_order.h"
#include "core/models/sliding/sliding.h"
#include "core/plan/scene_problem.h"
#include "tests/support/claims/impact_change.h"
#include "tests/support/claims/impact_tally.h"
#include "tests/support/scenes/plan_scenes.h"

namespace ricochet {
namespace {

constexpr int kScenes = 100'000;

// The rounding error of exact models, which matters if an answer is large compared with max(|u0|, |v0|).
double NoiseOf(const planar::Problem& problem, const Ending<1>& end) {
  return 0x1p-50 * (1.0 + ChangeBetween(problem, {}, end));
}

TEST(SizesTest, FrictionOfAPlanarContact) {
  PlanScenes scenes(1);
  ImpactTally tally("friction");
  for (int i = 0; i < kScenes; ++i) {
    const planar::Problem problem = scenes.Planar();
    const auto with = EndingOf(planar::Solve(problem));
    const auto without = EndingOf(planar::Solve(Smooth(problem)));
    const Size size = PlanarSizes(problem, {})[Effect::kFriction];
    tally.Add(OverSpeed(size, problem), ChangeBetween(problem, with, without), NoiseOf(problem, with),
              scenes.Tolerance());
  }
  tally.Finish(1000);
  tally.ExpectSharpInPlay();
}

TEST(SizesTest, SlipThatStopsInAPlane) {
  PlanScenes scenes(2);
  ImpactTally tally("slip that stops");
  for (int i = 0; i < kScenes; ++i) {
    const planar::Problem problem = scenes.Planar();
    const Size size = PlanarSizes(problem, {})[Effect::kSlipStop];
    if (problem.u0 == 0.0 || problem.mu == 0.0 || planar::SceneSource::IsRankOne(problem)) continue;
    if (problem.coefficient > 1.0 || !(sliding::SlidingSlopes(SlidingProblemOf(problem)).v > 1e-6 * problem.w.nn))
      continue;
    const auto with = EndingOf(planar::Solve(problem));
    const auto without = EndingOf(sliding::Solve(SlidingProblemOf(problem)));
    const double noise = NoiseOf(problem, with) + sliding::ErrorsOf(SlidingProblemOf(problem)).Largest();
    tally.Add(OverSpeed(size, problem), ChangeBetween(problem, with, without), noise, scenes.Tolerance());
  }
  tally.Finish(1000);
  tally.ExpectSharpInPlay();
}

TEST(SizesTest, StaticFrictionInAPlane) {
  PlanScenes scenes(3);
  ImpactTally tally("static friction");
  for (int i = 0; i < kScenes; ++i) {
    planar::Problem problem = scenes.Planar();
    if (scenes.Below(8) == 0) problem.mu = std::fabs(problem.w.tn) / problem.w.tt * (1.0 - scenes.Power(-6.0, -0.5));
    problem.mu_static = problem.mu * (1.0 + scenes.Power(-4.0, 1.0));
    if (!std::isfinite(problem.mu)) continue;
    const auto with = EndingOf(planar::Solve(problem));
    const auto without = EndingOf(planar::Solve(WithoutStatic(problem)));
    const Size size = PlanarSizes(problem, {})[Effect::kStaticFriction];
    tally.Add(OverSpeed(size, problem), ChangeBetween(problem, with, without), NoiseOf(problem, with),
              scenes.Tolerance());
  }
  tally.Finish(1000);
}

TEST(SizesTest, FrictionOfAPendulum) {
  PlanScenes scenes(4);
  ImpactTally tally("friction, pendulum");
  for (int i = 0; i < kScenes; ++i) {
    const pendulum::Problem problem = scenes.Pendulum();
    const planar::Problem planar = PlanarOf(problem);
    const auto with = EndingOf(pendulum::Solve(problem));
    const auto without = EndingOf(pendulum::Solve(Smooth(problem)));
    const Size size = PendulumSizes(problem, {})[Effect::kFriction];
    tally.Add(OverSpeed(size, planar), ChangeBetween(planar, with, without), NoiseOf(planar, with), scenes.Tolerance());
  }
  tally.Finish(1000);
  tally.ExpectSharpInPlay();
}

TEST(SizesTest, HigherOrderOfAPendulum) {
  PlanScenes scenes(5);
  ImpactTally tally("higher order");
  for (int i = 0; i < kScenes; ++i) {
    const pendulum::Problem problem = scenes.Pendulum();
    const Size size = PendulumSizes(problem, {})[Effect::kHigherOrder];
    if (!first_order::Serves(problem)) continue;
    const planar::Problem planar = PlanarOf(problem);
    const auto with = EndingOf(pendulum::Solve(problem));
    const auto without = EndingOf(first_order::Solve(problem));
    tally.Add(OverSpeed(size, planar), ChangeBetween(planar, with, without), NoiseOf(planar, with), scenes.Tolerance());
  }
  tally.Finish(1000);
  tally.ExpectSharpInPlay();
}

TEST(SizesTest, FrictionInSpace) {
  PlanScenes scenes(6);
  ImpactTally tally("friction, space");
  for (int i = 0; i < kScenes / 4; ++i) {
    const spatial::Problem problem = scenes.Spatial();
    const spatial::Impact with = spatial::Solve(problem);
    const auto without = EndingOf(spatial::Solve(Smooth(problem)));
    const Size size = SpatialSizes(problem)[Effect::kFriction];
    tally.Add(OverSpeed(size, problem), ChangeBetween(problem, EndingOf(with), without), with.error_estimate,
              scenes.Tolerance());
  }
  tally.Finish(1000);
  tally.ExpectSharpInPlay();
}

// The first-order form leaves out both effects together.
TEST(SizesTest, SlipThatTurnsOrStopsInSpace) {
  PlanScenes scenes(7);
  ImpactTally tally("slip that turns and stops");
  for (int i = 0; i < kScenes / 4; ++i) {
    const spatial::Problem problem = scenes.Spatial();
    const auto line = SlidingProblemOf(problem);
    if (!(sliding::SlidingSlopes(line).v > 1e-6 * problem.w33)) continue;
    const spatial::Impact with = spatial::Solve(problem);
    const Sizes sizes = SpatialSizes(problem);
    Size size = sizes[Effect::kSlipTurn];
    size.value += sizes[Effect::kSlipStop].value;
    const double noise = with.error_estimate + sliding::ErrorsOf(line).Largest();
    tally.Add(OverSpeed(size, problem), ChangeBetween(problem, EndingOf(with), EndingOf(sliding::Solve(line))), noise,
              scenes.Tolerance());
  }
  tally.Finish(1000);
  tally.ExpectSharpInPlay();
}

TEST(SizesTest, StaticFrictionInSpace) {
  PlanScenes scenes(8);
  ImpactTally tally("static friction, space");
  for (int i = 0; i < kScenes / 4; ++i) {
    spatial::Problem problem = scenes.Spatial();
    if (scenes.Below(8) == 0) problem.mu = spatial::SceneSource::StickFriction(problem) * scenes.Uniform(0.5, 1.0);
    problem.mu_static = problem.mu * scenes.Uniform(1.0, 3.0);
    const spatial::Impact with = spatial::Solve(problem);
    const spatial::Impact without = spatial::Solve(WithoutStatic(problem));
    const Size size = SpatialSizes(problem)[Effect::kStaticFriction];
    tally.Add(OverSpeed(size, problem), ChangeBetween(problem, EndingOf(with), EndingOf(without)),
              with.error_estimate + without.error_estimate, scenes.Tolerance());
  }
  tally.Finish(1000);
}

}  // namespace
}  // namespace ricochet
