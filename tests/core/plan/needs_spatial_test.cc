// A contact that is said to need the spatial model gets it from ChooseSpatial, also where a size lies next to the
// tolerance, and few typical contacts are left open.

#include "core/plan/needs_spatial.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "core/plan/choose.h"
#include "core/plan/sizes.h"
#include "tests/support/scenes/plan_scenes.h"
#include "tests/support/scenes/spatial_scenes.h"

namespace ricochet {
namespace {

// Tolerances at and around the sizes that decide.
std::vector<double> CriticalTolerances(const spatial::Problem& problem) {
  std::vector<double> tolerances = {0.0, 1e-12, 1e-10, 1e-6, 1e-2};
  if (problem.v0 >= 0.0) return tolerances;
  const Sizes sizes = SpatialSizes(problem);
  for (const Effect effect : {Effect::kFriction, Effect::kSlipTurn}) {
    for (const double nearby : {-0.5, -0x1p-17, -0x1p-30, -0x1p-52, 0.0, 0x1p-52, 0x1p-30, 0x1p-17, 1.0}) {
      const double tolerance = sizes[effect].value * (1.0 + nearby);
      if (tolerance <= 0.1) tolerances.push_back(tolerance);
    }
  }
  return tolerances;
}

void ExpectThatTheChoiceAgrees(const spatial::Problem& problem) {
  for (const double tolerance : CriticalTolerances(problem)) {
    if (!NeedsSpatial(problem, tolerance)) continue;
    const Choice choice = ChooseSpatial(problem, {.relative_tolerance = tolerance});
    EXPECT_EQ(choice.model, Model::kSpatial) << "tolerance " << tolerance << ", mu " << problem.mu;
    EXPECT_TRUE(choice.left_out.IsEmpty());
    EXPECT_EQ(choice.negligible, 0.0);
  }
}

TEST(NeedsSpatialTest, TheChoiceAgreesAtCriticalTolerances) {
  PlanScenes source(41);
  for (int i = 0; i < 20'000 && !HasFailure(); ++i) ExpectThatTheChoiceAgrees(source.Spatial());
}

// Slip that turns by little, with friction and coupling from nearly none to very much.
TEST(NeedsSpatialTest, TheChoiceAgreesForContactsOfAllScales) {
  spatial::SceneSource source(42);
  const auto power = [&source](double most) { return std::exp2(source.Uniform(-most, most)); };
  for (int i = 0; i < 20'000 && !HasFailure(); ++i) {
    spatial::Problem problem = source.Typical();
    problem.mu = problem.mu_static = power(30.0);
    for (double& u : problem.u0) u *= power(30.0);
    problem.w12 *= power(-30.0);
    problem.w33 *= std::exp2(source.Uniform(0.0, 40.0));
    if (source.Below(4) == 0) problem.w11 = problem.w22 * (1.0 + 1e-12 * source.Uniform(0.0, 1.0));
    if (source.Below(4) == 0) problem.u0 = {};
    if (source.Below(4) == 0) problem.u0[source.Below(2)] = 0.0;
    ExpectThatTheChoiceAgrees(problem);
  }
}

TEST(NeedsSpatialTest, FewTypicalContactsAreLeftOpen) {
  constexpr int kCount = 10'000;
  spatial::SceneSource source(43);
  int open = 0;
  for (int i = 0; i < kCount; ++i) open += NeedsSpatial(source.Typical(), 1e-6) ? 0 : 1;
  EXPECT_LT(open, kCount / 50);
}

}  // namespace
}  // namespace ricochet
