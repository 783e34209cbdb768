// A plan in words has every effect once, in order, each with its reason and numbers.

#include "core/plan/explain.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "tests/support/scenes/plan_scenes.h"

namespace ricochet {
namespace {

planar::Problem Slider() {
  return {.w = {1.0, 0.1, 1.0}, .u0 = 5.0, .v0 = -1.0, .mu = 0.3, .mu_static = 0.3, .coefficient = 0.5};
}

PlannedEffect On(const Plan& plan, Effect effect) { return plan.effects.List()[static_cast<size_t>(effect) - 1]; }

Plan InWords(const Choice& choice, const Demand& demand) {
  Plan plan;
  Explain(choice, demand, plan);
  return plan;
}

Plan PlanOf(const planar::Problem& problem, const ContactPhysics& physics, const Demand& demand) {
  return InWords(ChoosePlanar(problem, physics, demand), demand);
}

TEST(ExplainTest, EveryEffectOnceInOrderWithAReason) {
  PlanScenes scenes(41);
  for (int i = 0; i < 20'000 && !HasFailure(); ++i) {
    const Demand demand = {.relative_tolerance = scenes.Tolerance()};
    const Plan plans[] = {InWords(ChoosePlanar(scenes.Planar(), {.ratio_squared = 0.5}, demand), demand),
                          InWords(ChoosePendulum(scenes.Pendulum(), {}, demand), demand),
                          InWords(ChooseSpatial(scenes.Spatial(), demand), demand)};
    for (const Plan& plan : plans) {
      const std::vector<PlannedEffect> effects = plan.effects.List();
      ASSERT_EQ(effects.size(), static_cast<size_t>(kEffectCount - 1));
      double neglected = 0.0;
      for (size_t k = 0; k < effects.size(); ++k) {
        const PlannedEffect& planned = effects[k];
        EXPECT_EQ(static_cast<size_t>(planned.effect), k + 1);
        EXPECT_NE(planned.decision, Decision::kUnspecified);
        EXPECT_FALSE(planned.reason.empty());
        if (planned.decision == Decision::kAbsent) {
          EXPECT_EQ(planned.size, 0.0);
        }
        if (planned.decision == Decision::kNegligible) neglected += planned.size;
      }
      EXPECT_EQ(plan.neglected, neglected);
      EXPECT_EQ(plan.relative_tolerance, demand.relative_tolerance);
    }
  }
}

// u1 = 5 + (0.1 - 0.3) tau1, tau1 = 1.5/0.97.
TEST(ExplainTest, SlipThatNeverStopsSaysWhereItEnds) {
  const Plan plan = PlanOf(Slider(), {.ratio_squared = 1.2}, {.relative_tolerance = 1e-3});
  EXPECT_EQ(plan.model, Model::kSliding);
  EXPECT_EQ(On(plan, Effect::kSlipStop).reason, "slip never stops: it ends at 4.69 m/s");
  EXPECT_EQ(On(plan, Effect::kTangentialCompliance).reason, "the contact slides throughout");
  EXPECT_EQ(On(plan, Effect::kSlipTurn).reason, "in a plane slip cannot turn");
  EXPECT_EQ(On(plan, Effect::kStaticFriction).reason, "the static and the kinetic coefficient are equal");
  EXPECT_EQ(On(plan, Effect::kFiniteForces).reason, "the scene has no finite forces");
}

TEST(ExplainTest, FrictionSaysWhatItIsInAndWhatItChanges) {
  planar::Problem problem = Slider();
  problem.mu = problem.mu_static = 1e-4;
  const Plan plan = PlanOf(problem, {}, {.relative_tolerance = 1e-2});
  EXPECT_EQ(plan.model, Model::kFrictionless);
  const PlannedEffect& friction = On(plan, Effect::kFriction);
  EXPECT_EQ(friction.decision, Decision::kNegligible);
  EXPECT_EQ(friction.reason, "mu |Wtn|/Wnn = 1e-05: friction changes velocities by at most 0.000152");
}

// Forces that press make impulses larger, and friction with them.
TEST(ExplainTest, SizesBesideFiniteForcesSayThatTheyAreThoseWithoutThem) {
  const ContactPhysics pressed = {.spring = LinearSpring{1e4}, .normal_acceleration = -200.0};
  const Plan plan = PlanOf(Slider(), pressed, {.relative_tolerance = 1e-3});
  EXPECT_EQ(plan.model, Model::kFiniteDuration);
  for (const Effect effect : {Effect::kFriction, Effect::kSlipStop}) {
    EXPECT_EQ(On(plan, effect).reason.rfind("without the finite forces, ", 0), 0U) << On(plan, effect).reason;
  }
  EXPECT_EQ(On(plan, Effect::kFiniteForces).reason.find("without"), std::string::npos);
}

TEST(ExplainTest, APendulumSpeaksOfX) {
  const pendulum::Problem problem = {
      .inertia = 1.0, .a = 1.0, .b = 0.1, .omega_minus = -1.0, .mu = 0.1, .mu_static = 0.1, .coefficient = 0.5};
  const Demand demand = {.relative_tolerance = 1e-3};
  const Plan plan = InWords(ChoosePendulum(problem, {}, demand), demand);
  EXPECT_EQ(On(plan, Effect::kFriction).reason.substr(0, 20), "x = mu |b|/a = 0.01:");
  EXPECT_EQ(On(plan, Effect::kSlipStop).reason, "slip stops at the end of compression, as for every pendulum");
  EXPECT_EQ(On(plan, Effect::kHigherOrder).decision, Decision::kSimulated);
}

TEST(ExplainTest, WhatLivesOnFrictionIsCountedThere) {
  const Plan plan = PlanOf(Slider(), {}, {.excluded = {Effect::kFriction}});
  EXPECT_EQ(On(plan, Effect::kFriction).decision, Decision::kExcluded);
  EXPECT_GT(On(plan, Effect::kFriction).size, 0.09);
  EXPECT_EQ(plan.neglected, On(plan, Effect::kFriction).size);
}

TEST(ExplainTest, SelfLockingAndDampingHaveNoBound) {
  planar::Problem jam = Slider();
  jam.w.tn = 0.9;
  jam.mu = jam.mu_static = 1.2;
  const Plan locked = PlanOf(jam, {}, {});
  EXPECT_TRUE(std::isinf(On(locked, Effect::kFriction).size));
  EXPECT_EQ(On(locked, Effect::kFriction).reason,
            "friction may lock the contact, as the coefficient times |Wtn| is 1.08 Wnn: no bound is known");
  const Plan damped = PlanOf(Slider(), {.spring = HuntCrossleySpring{1e6, 1.5, 0.3}}, {});
  EXPECT_EQ(On(damped, Effect::kFiniteDuration).reason, "the damping of the spring determines the restitution");
}

TEST(ExplainTest, ASeparatingContactSaysSo) {
  planar::Problem problem = Slider();
  problem.v0 = 1.0;
  const Plan plan = PlanOf(problem, {}, {});
  EXPECT_EQ(plan.model, Model::kNone);
  for (const PlannedEffect& planned : plan.effects.List()) {
    EXPECT_EQ(planned.reason, "the contact separates: nothing changes");
  }
}

}  // namespace
}  // namespace ricochet
