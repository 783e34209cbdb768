// The change by tangential compliance never exceeds its size, and is 0 if the contact slides throughout.

#include <gtest/gtest.h>

#include <cmath>

#include "core/models/compliant/compliant.h"
#include "core/models/planar/planar.h"
#include "core/plan/sizes.h"
#include "tests/support/claims/impact_change.h"
#include "tests/support/claims/impact_tally.h"
#include "tests/support/claims/planned_answer.h"
#include "tests/support/scenes/plan_scenes.h"

namespace ricochet {
namespace {

constexpr int kScenes = 100'000;

TEST(ComplianceSizeTest, OfTangentialCompliance) {
  PlanScenes scenes(11);
  ImpactTally tally("tangential compliance");
  for (int i = 0; i < kScenes; ++i) {
    planar::Problem problem = scenes.ForSprings();
    const double ratio_squared = scenes.Power(-2.0, 1.0);
    // These contacts nearly stick at once.
    if (scenes.Below(16) == 0) {
      problem.u0 = std::copysign(
          problem.mu * ratio_squared * problem.v0 * (1.0 + scenes.Sign() * scenes.Power(-12.0, 0.0)), problem.u0);
    }
    const compliant::Impact with = compliant::Solve(CompliantOf(problem, ratio_squared));
    const auto without = EndingOf(planar::Solve(problem));
    const Size size = PlanarSizes(problem, {.ratio_squared = ratio_squared})[Effect::kTangentialCompliance];
    tally.Add(OverSpeed(size, problem), ChangeBetween(problem, EndingOf(with), without),
              4.0 * with.error_estimate + 1e-14, scenes.Tolerance());
  }
  tally.Finish(1000);
}

TEST(ComplianceSizeTest, FrictionOfACompliantContact) {
  PlanScenes scenes(12);
  ImpactTally tally("friction, compliant");
  for (int i = 0; i < kScenes / 2; ++i) {
    const planar::Problem problem = scenes.ForSprings();
    const double ratio_squared = scenes.Power(-2.0, 1.0);
    const compliant::Impact with = compliant::Solve(CompliantOf(problem, ratio_squared));
    const auto without = EndingOf(planar::Solve(Smooth(problem)));
    const Size size = PlanarSizes(problem, {.ratio_squared = ratio_squared})[Effect::kFriction];
    tally.Add(OverSpeed(size, problem), ChangeBetween(problem, EndingOf(with), without),
              4.0 * with.error_estimate + 1e-14, scenes.Tolerance());
  }
  tally.Finish(1000);
}

}  // namespace
}  // namespace ricochet
