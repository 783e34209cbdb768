// Demands that are refused, each with its path and reason.

#include "core/plan/demand.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace ricochet {
namespace {

Scene Contact() {
  Scene scene;
  scene.system = PlanarContact{1.0, 0.1, 1.0, 5.0, -1.0};
  scene.friction.kinetic_coefficient = 0.3;
  scene.restitution = EnergeticCoefficient{0.5};
  return scene;
}

Scene Swinging() {
  Scene scene = Contact();
  scene.system = Pendulum{1.0, 1.0, 0.1, -1.0};
  return scene;
}

Scene InSpace() {
  Scene scene = Contact();
  scene.system = SpatialContact{{1.96, .24, .6, 2.96, -.8, 1.85}, {1.0, .6}, -1.0};
  return scene;
}

Scene Sprung(NormalSpring spring) {
  Scene scene = Contact();
  scene.compliance = Compliance{.normal = spring};
  return scene;
}

// Each violation as "path description".
std::vector<std::string> Texts(const Scene& scene, const Demand& demand) {
  std::vector<std::string> texts;
  std::optional<SceneContact> contact;
  for (const Violation& violation : CheckDemand(scene, contact, demand)) {
    texts.push_back(violation.field + " " + violation.description);
  }
  return texts;
}

using Expected = std::vector<std::string>;

TEST(DemandTest, WhatTheSceneHasMayBeDemanded) {
  EXPECT_EQ(Texts(Contact(), {}), Expected());
  EXPECT_EQ(Texts(Contact(), {.required = {Effect::kSlipStop, Effect::kFriction}}), Expected());
  EXPECT_EQ(Texts(Contact(), {.excluded = {Effect::kSlipStop, Effect::kTangentialCompliance}}), Expected());
  EXPECT_EQ(Texts(Swinging(), {.excluded = {Effect::kHigherOrder}}), Expected());
  EXPECT_EQ(Texts(InSpace(), {.excluded = {Effect::kSlipTurn}}), Expected());
  EXPECT_EQ(Texts(Sprung(LinearSpring{1e6}), {.required = {Effect::kFiniteDuration}}), Expected());
}

TEST(DemandTest, TheToleranceLiesInItsRange) {
  EXPECT_EQ(Texts(Contact(), {.relative_tolerance = 0.2}), Expected({"relative_tolerance = 0.2: must be in [0, 0.1]"}));
  EXPECT_EQ(Texts(Contact(), {.relative_tolerance = -1.0}), Expected({"relative_tolerance = -1: must be in [0, 0.1]"}));
  EXPECT_EQ(Texts(Contact(), {.relative_tolerance = 0.0}), Expected());
}

TEST(DemandTest, AnEffectThatTheSceneLacksCannotBeRequired) {
  Scene smooth = Contact();
  smooth.friction.kinetic_coefficient = 0.0;
  EXPECT_EQ(
      Texts(smooth, {.required = {Effect::kSlipStop}}),
      Expected({"required[0] = slip_stop: must not be required of a scene without friction.kinetic_coefficient > 0"}));
  EXPECT_EQ(Texts(Contact(), {.required = {Effect::kFriction, Effect::kTangentialCompliance}}),
            Expected({"required[1] = tangential_compliance: must not be required of a scene without "
                      "compliance.tangential_ratio_squared"}));
  EXPECT_EQ(Texts(Contact(), {.required = {Effect::kSlipTurn, Effect::kStaticFriction, Effect::kFiniteDuration,
                                           Effect::kFiniteForces, Effect::kHigherOrder}}),
            Expected({"required[0] = slip_turn: must not be required of a scene without a system in space",
                      "required[1] = static_friction: must not be required of a scene without "
                      "friction.static_coefficient > friction.kinetic_coefficient",
                      "required[2] = finite_duration: must not be required of a scene without a normal spring in "
                      "compliance",
                      "required[3] = finite_forces: must not be required of a scene without finite forces",
                      "required[4] = higher_order: must not be required of a scene without a pendulum over a surface "
                      "at rest"}));
}

TEST(DemandTest, WhatIsExcludedCannotBeRequired) {
  EXPECT_EQ(Texts(Contact(), {.required = {Effect::kFriction}, .excluded = {Effect::kFriction}}),
            Expected({"required[0] = friction: must not be excluded too"}));
  EXPECT_EQ(Texts(Contact(), {.required = {Effect::kSlipStop}, .excluded = {Effect::kFriction}}),
            Expected({"required[0] = slip_stop: must not be required where friction is excluded"}));
  Scene pressed = Sprung(LinearSpring{1e6});
  pressed.finite_forces = ContactAcceleration{0.0, -9.81};
  EXPECT_EQ(Texts(pressed, {.required = {Effect::kFiniteForces}, .excluded = {Effect::kFiniteDuration}}),
            Expected({"required[0] = finite_forces: must not be required where finite_duration is excluded"}));
}

TEST(DemandTest, WhatEveryModelHasCannotBeExcluded) {
  EXPECT_EQ(Texts(Sprung(HuntCrossleySpring{1e6, 1.5, 0.3}), {.excluded = {Effect::kFiniteDuration}}),
            Expected({"excluded[0] = finite_duration: must be left in: the spring's damping is the restitution"}));
  EXPECT_EQ(Texts(Contact(), {.excluded = {Effect::kHigherOrder}}),
            Expected({"excluded[0] = higher_order: must be left in: only a pendulum over a surface at rest has a "
                      "first-order form"}));
  EXPECT_EQ(Texts(Contact(), {.excluded = {Effect::kSlipTurn}}),
            Expected({"excluded[0] = slip_turn: must be left in: in a plane slip cannot turn"}));
  EXPECT_EQ(
      Texts(Swinging(), {.excluded = {Effect::kSlipStop}}),
      Expected({"excluded[0] = slip_stop: must be left in: a pendulum's slip stops where compression ends; exclude "
                "friction"}));
  Scene pressed = Sprung(LinearSpring{1e6});
  pressed.finite_forces = ContactAcceleration{0.0, -9.81};
  EXPECT_EQ(Texts(pressed, {.excluded = {Effect::kSlipStop}}),
            Expected({"excluded[0] = slip_stop: must be left in: the model of finite duration has slip that stops; "
                      "exclude friction"}));
  EXPECT_EQ(Texts(pressed, {.excluded = {Effect::kSlipStop, Effect::kFiniteForces}}), Expected());
}

TEST(DemandTest, FormsThatTheContactDoesNotHaveCannotBeForced) {
  const std::string slip =
      ": must be left in: slip in a straight line needs u0 != 0, mu |Wtn| < Wnn, a W of full rank and a coefficient of "
      "restitution <= 1";
  Scene resting = Contact();
  std::get<PlanarContact>(resting.system).tangential_m_s = 0.0;
  EXPECT_EQ(Texts(resting, {.excluded = {Effect::kSlipStop}}), Expected({"excluded[0] = slip_stop" + slip}));
  Scene jammed = InSpace();
  jammed.friction.kinetic_coefficient = 3.0;
  EXPECT_EQ(Texts(jammed, {.excluded = {Effect::kSlipTurn, Effect::kSlipStop}}),
            Expected({"excluded[0] = slip_stop" + slip, "excluded[1] = slip_turn" + slip}));
  Scene steep = Swinging();
  steep.friction.kinetic_coefficient = 8.0;
  EXPECT_EQ(
      Texts(steep, {.excluded = {Effect::kHigherOrder}}),
      Expected({"excluded[0] = higher_order: must be left in: the first-order form needs mu |b|/a <= 0.5, no lock, "
                "and a coefficient within its own bound"}));
  EXPECT_EQ(Texts(steep, {.excluded = {Effect::kHigherOrder, Effect::kFriction}}), Expected());
}

TEST(DemandTest, AnImpactLawLeavesNoChoice) {
  Scene scene = Contact();
  scene.restitution = std::monostate();
  scene.impact_law = WhittakerLaw{0.5};
  EXPECT_EQ(Texts(scene, {}), Expected());
  EXPECT_EQ(Texts(scene, {.required = {Effect::kFriction}}),
            Expected({"required[0] = friction: must not be here: an impact law states its own effects"}));
}

}  // namespace
}  // namespace ricochet
