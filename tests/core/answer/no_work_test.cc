// An effect that the plan leaves out costs nothing: none of its code is called.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <optional>

#include "core/answer/scene_outcome.h"
#include "tests/support/scenes/system_scenes.h"

namespace ricochet {
namespace {

struct Cost {
  int64_t steps;
  Model model;
};

Cost CostOf(const Scene& scene, const Demand& demand = {}) {
  std::optional<SceneContact> contact;
  Outcome outcome;
  const absl::Status status = SolveScene(
      scene, contact, demand, {}, [] { return false; }, outcome);
  EXPECT_TRUE(status.ok()) << status;
  EXPECT_EQ(outcome.accuracy.right_hand_sides > 0, outcome.accuracy.steps > 0);
  return {outcome.accuracy.steps, outcome.plan.model};
}

Scene WithSpring(Scene scene, const NormalSpring& spring = LinearSpring{1e6}) {
  scene.compliance = {.normal = spring};
  return scene;
}

TEST(NoWorkTest, RigidScenesInAPlaneAreNotIntegrated) {
  for (const System& system :
       {System(Flat()), System(Chain()), System(Contact()), System(Pendulum{1.0, 0.3, 1.0, -1.0})}) {
    const Cost cost = CostOf(With(system));
    EXPECT_EQ(cost.steps, 0) << system.index();
  }
}

TEST(NoWorkTest, ASpringThatChangesNoImpulseIsNotIntegratedUnlessItIsRequired) {
  for (const NormalSpring& spring : {NormalSpring(LinearSpring{1e6}), NormalSpring(HertzSpring{1e9})}) {
    EXPECT_EQ(CostOf(WithSpring(With(Contact()), spring)).steps, 0);
    const Cost required = CostOf(WithSpring(With(Contact()), spring),
                                 {.relative_tolerance = 1e-6, .required = {Effect::kFiniteDuration}});
    EXPECT_GT(required.steps, 0);
    EXPECT_EQ(required.model, Model::kFiniteDuration);
  }
}

TEST(NoWorkTest, GravityIsIntegratedOnlyWhereItMattersAtTheToleranceAsked) {
  Scene scene = WithSpring(With(Flat()), LinearSpring{1e9});
  scene.finite_forces = Gravity{0.0, -9.81};
  EXPECT_EQ(CostOf(scene, {.relative_tolerance = 0.1}).steps, 0);
  EXPECT_GT(CostOf(scene, {.relative_tolerance = 1e-7}).steps, 0);
  EXPECT_EQ(CostOf(scene, {.relative_tolerance = 1e-7, .excluded = {Effect::kFiniteForces}}).steps, 0);
}

TEST(NoWorkTest, SlipThatDoesNotTurnIsNotIntegrated) {
  Scene scene = With(ContactInSpace());
  scene.friction.kinetic_coefficient = 0.2;
  EXPECT_GT(CostOf(scene).steps, 0);
  std::get<SpatialContact>(scene.system).tangential_m_s = {3000.0, 1800.0};
  const Cost straight = CostOf(scene, {.relative_tolerance = 0.01});
  EXPECT_EQ(straight.steps, 0);
  EXPECT_EQ(straight.model, Model::kSliding);
  scene.friction.kinetic_coefficient = 0.0;
  const Cost smooth = CostOf(scene);
  EXPECT_EQ(smooth.steps, 0);
  EXPECT_EQ(smooth.model, Model::kFrictionless);
}

TEST(NoWorkTest, ACompliantContactThatSlipsThroughoutIsSolvedAsARigidOne) {
  Scene scene = With(Contact());
  scene.friction.kinetic_coefficient = 0.2;
  scene.compliance = {.tangential_ratio_squared = 1.2, .normal = {}};
  std::get<PlanarContact>(scene.system).tangential_m_s = 0.1;
  EXPECT_EQ(CostOf(scene).model, Model::kCompliant);
  std::get<PlanarContact>(scene.system).tangential_m_s = 5.0;
  EXPECT_EQ(CostOf(scene).model, Model::kSliding);
}

}  // namespace
}  // namespace ricochet
