// The choice: the cheapest model that is proved to be within the tolerance and does what the caller asks for.

#include "core/plan/choose.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "core/models/restitution_law.h"
#include "core/plan/explain.h"
#include "core/plan/perturbed_path.h"
#include "core/plan/scene_problem.h"
#include "tests/support/claims/planned_answer.h"
#include "tests/support/scenes/known_contacts.h"
#include "tests/support/scenes/plan_scenes.h"

namespace ricochet {
namespace {

constexpr int kScenes = 100'000;
// The error of a model that is exact to an ulp or two of its own answer.
constexpr double kUlps = 0x1p-50;

class Usage {
 public:
  void Add(Model model) { ++counts_[static_cast<size_t>(model)]; }
  int operator[](Model model) const { return counts_[static_cast<size_t>(model)]; }
  void Print(const char* of) const {
    std::printf("  %s:", of);
    for (int i = 0; i < kModelCount; ++i) {
      if (counts_[static_cast<size_t>(i)] > 0) std::printf(" model %d %d", i, counts_[static_cast<size_t>(i)]);
    }
    std::printf("\n");
  }

 private:
  std::array<int, kModelCount> counts_ = {};
};

double SomeTolerance(PlanScenes& scenes) { return scenes.Below(32) == 0 ? 0.0 : scenes.Tolerance(); }

// Half of the scenes have compliance.
struct PlanarScene {
  planar::Problem problem;
  ContactPhysics physics;
};
PlanarScene SomePlanarScene(PlanScenes& scenes) {
  PlanarScene scene = {.problem = scenes.Planar()};
  if (scenes.Below(2) == 0) return scene;
  scene.problem = scenes.ForSprings();
  scene.physics.ratio_squared = scenes.Power(-2.0, 1.0);
  return scene;
}

double NoiseOf(const planar::Problem& problem, const Answer<1>& full) {
  return kUlps * (1.0 + ChangeBetween(problem, {}, full.end)) + 4.0 * full.error;
}

TEST(ChooseTest, PlanarAnswersAreWithinTheTolerance) {
  PlanScenes scenes(31);
  Usage usage;
  for (int i = 0; i < kScenes && !HasFailure(); ++i) {
    const auto [problem, physics] = SomePlanarScene(scenes);
    const Demand demand = {.relative_tolerance = SomeTolerance(scenes)};
    const Choice choice = ChoosePlanar(problem, physics, demand);
    const Answer<1> full = FullAnswer(problem, physics);
    const Answer<1> planned = PlannedAnswer(choice, problem, physics);
    EXPECT_LE(ChangeBetween(problem, full.end, planned.end), demand.relative_tolerance + NoiseOf(problem, full))
        << i << " by model " << static_cast<int>(choice.model);
    EXPECT_LE(choice.neglected, demand.relative_tolerance);
    usage.Add(choice.model);
  }
  usage.Print("planar");
  for (const Model model : {Model::kFrictionless, Model::kSliding, Model::kPlanar, Model::kCompliant}) {
    EXPECT_GT(usage[model], kScenes / 50);
  }
}

// The closed form leaves out nothing of a rigid pendulum.
TEST(ChooseTest, AnswersOfPendulumsAreWithinWhatTheCallerExcludes) {
  PlanScenes scenes(32);
  Usage usage;
  for (int i = 0; i < kScenes && !HasFailure(); ++i) {
    const pendulum::Problem problem = scenes.Pendulum();
    const Answer<1> full = {.end = EndingOf(pendulum::Solve(problem))};
    const planar::Problem planar = PlanarOf(problem);
    for (const EffectSet excluded : {EffectSet{}, EffectSet{Effect::kFriction}, EffectSet{Effect::kHigherOrder}}) {
      const Demand demand = {.relative_tolerance = SomeTolerance(scenes), .excluded = excluded};
      const Choice choice = ChoosePendulum(problem, {}, demand);
      usage.Add(choice.model);
      if (choice.model == Model::kUnspecified && excluded.Has(Effect::kHigherOrder)) continue;
      EXPECT_LE(ChangeBetween(planar, full.end, PlannedAnswer(choice, problem).end),
                OverSpeed({.value = choice.neglected}, planar).value + NoiseOf(planar, full))
          << i << " by model " << static_cast<int>(choice.model);
    }
  }
  usage.Print("pendulum");
  for (const Model model : {Model::kFrictionless, Model::kFirstOrder, Model::kPendulum}) {
    EXPECT_GT(usage[model], kScenes / 50);
  }
}

TEST(ChooseTest, TheCheapChoiceOfAPendulumIsTheWholeOne) {
  PlanScenes scenes(29);
  Usage usage;
  for (int i = 0; i < kScenes; ++i) {
    pendulum::Problem problem = scenes.Pendulum();
    if (i % 8 == 0) problem.omega_minus = -problem.omega_minus;
    if (i % 8 == 1) problem.mu = problem.mu_static = 0.0;
    const double tolerance = SomeTolerance(scenes);
    const Choice choice = ChoosePendulum(problem, {}, {.relative_tolerance = tolerance});
    ASSERT_EQ(ModelOfPendulum(problem, tolerance), choice.model) << "scene " << i;
    usage.Add(choice.model);
  }
  for (const Model model : {Model::kNone, Model::kFrictionless, Model::kPendulum}) EXPECT_GT(usage[model], 100);
}

TEST(ChooseTest, AnswersInSpaceAreWithinTheTolerance) {
  PlanScenes scenes(33);
  Usage usage;
  for (int i = 0; i < kScenes / 4 && !HasFailure(); ++i) {
    const spatial::Problem problem = scenes.Spatial();
    const Demand demand = {.relative_tolerance = SomeTolerance(scenes)};
    const Choice choice = ChooseSpatial(problem, demand);
    const spatial::Impact full = spatial::Solve(problem);
    const Answer<2> planned = PlannedAnswer(choice, problem);
    const double allowed = std::max(demand.relative_tolerance, planned.error) + full.error_estimate;
    Ending<2> end = EndingOf(full);
    // The tolerance of the spatial model is one of velocities; its estimate says so if it does not reach the tolerance.
    if (choice.model == Model::kSpatial) {
      end.f1 = planned.end.f1;
      end.tau1 = planned.end.tau1;
    }
    EXPECT_LE(ChangeBetween(problem, end, planned.end), 1.0001 * allowed)
        << i << " by model " << static_cast<int>(choice.model);
    usage.Add(choice.model);
  }
  usage.Print("space");
  for (const Model model : {Model::kFrictionless, Model::kSliding, Model::kSpatial}) {
    EXPECT_GT(usage[model], kScenes / 400);
  }
}

TEST(ChooseTest, NoCheaperModelIsProvedToDo) {
  PlanScenes scenes(34);
  int sliding = 0;
  int more_expensive = 0;
  for (int i = 0; i < kScenes && !HasFailure(); ++i) {
    const auto [problem, physics] = SomePlanarScene(scenes);
    const double cone = problem.mu * std::fabs(problem.w.tn) / problem.w.nn;
    const bool rank_one = problem.w.tn * problem.w.tn > (1.0 - 1e-6) * problem.w.tt * problem.w.nn;
    if (problem.coefficient > 1.0 || cone > 0.99 || rank_one) continue;
    const Demand demand = {.relative_tolerance = SomeTolerance(scenes)};
    const Choice choice = ChoosePlanar(problem, physics, demand);
    const Sizes sizes = PlanarSizes(problem, physics);
    const auto line = SlidingProblemOf(problem);
    const double smooth = sizes[Effect::kFriction].value + sliding::FrictionlessErrorsOf(line).Largest();
    const double straight = sizes[Effect::kSlipStop].value + sizes[Effect::kStaticFriction].value +
                            sizes[Effect::kTangentialCompliance].value;
    EXPECT_EQ(choice.model == Model::kFrictionless, smooth <= demand.relative_tolerance);
    if (choice.model == Model::kFrictionless || problem.u0 == 0.0 || problem.mu == 0.0) continue;
    // Slip that would reverse until friction gives energy is no answer at any tolerance.
    const bool pushes = sizes[Effect::kSlipStop].value > 0.0 && sliding::FrictionPushes(line);
    const bool slides = !pushes && straight + sliding::ErrorsOf(line).Largest() <= demand.relative_tolerance;
    EXPECT_EQ(choice.model == Model::kSliding, slides);
    sliding += slides ? 1 : 0;
    if (slides) continue;
    ++more_expensive;
    const bool rigid = sizes[Effect::kTangentialCompliance].value <= demand.relative_tolerance;
    EXPECT_EQ(choice.model, rigid ? Model::kPlanar : Model::kCompliant);
  }
  EXPECT_GT(sliding, kScenes / 100);
  EXPECT_GT(more_expensive, kScenes / 100);
}

TEST(ChooseTest, ASmallerToleranceNeverTakesACheaperModel) {
  PlanScenes scenes(35);
  for (int i = 0; i < kScenes / 10 && !HasFailure(); ++i) {
    const auto [problem, physics] = SomePlanarScene(scenes);
    int before = 0;
    for (const double tolerance : {0.1, 1e-2, 1e-4, 1e-6, 1e-9, 1e-12, 0.0}) {
      const int model = static_cast<int>(ChoosePlanar(problem, physics, {.relative_tolerance = tolerance}).model);
      EXPECT_GE(model, before);
      before = model;
    }
  }
}

// ---- By hand ----

// A body of 1 kg slides on and does not stop: mu |Wtn|/Wnn = 0.03.
planar::Problem Slider() {
  return {.w = {1.0, 0.1, 1.0}, .u0 = 5.0, .v0 = -1.0, .mu = 0.3, .mu_static = 0.3, .coefficient = 0.5};
}

Decision On(const Choice& choice, Effect effect) { return choice.decisions[static_cast<size_t>(effect)]; }

TEST(ChooseTest, SlipThatNeverStopsIsAbsentAtAnyTolerance) {
  const Choice rough = ChoosePlanar(Slider(), {}, {.relative_tolerance = 1e-2});
  EXPECT_EQ(rough.model, Model::kSliding);
  EXPECT_EQ(On(rough, Effect::kSlipStop), Decision::kAbsent);
  EXPECT_EQ(On(rough, Effect::kFriction), Decision::kSimulated);
  EXPECT_EQ(rough.neglected, 0.0);
  const Choice exact = ChoosePlanar(Slider(), {}, {.relative_tolerance = 0.0});
  EXPECT_EQ(exact.model, Model::kPlanar);
  EXPECT_EQ(On(exact, Effect::kSlipStop), Decision::kAbsent);
}

TEST(ChooseTest, ARequiredEffectIsSimulatedEvenIfNegligible) {
  planar::Problem problem = Slider();
  problem.mu = problem.mu_static = 1e-4;
  const Choice free = ChoosePlanar(problem, {}, {.relative_tolerance = 1e-2});
  EXPECT_EQ(free.model, Model::kFrictionless);
  EXPECT_EQ(On(free, Effect::kFriction), Decision::kNegligible);
  EXPECT_GT(free.neglected, 0.0);
  const Choice forced = ChoosePlanar(problem, {}, {.relative_tolerance = 1e-2, .required = {Effect::kFriction}});
  EXPECT_EQ(forced.model, Model::kSliding);
  EXPECT_EQ(On(forced, Effect::kFriction), Decision::kRequired);
  const Choice stop = ChoosePlanar(problem, {}, {.relative_tolerance = 1e-2, .required = {Effect::kSlipStop}});
  EXPECT_EQ(stop.model, Model::kPlanar);
  EXPECT_EQ(On(stop, Effect::kSlipStop), Decision::kRequired);
}

TEST(ChooseTest, AnExcludedEffectIsLeftOutWhateverItsSize) {
  const planar::Problem problem = Slider();
  const Choice choice = ChoosePlanar(problem, {}, {.relative_tolerance = 1e-9, .excluded = {Effect::kFriction}});
  EXPECT_EQ(choice.model, Model::kFrictionless);
  EXPECT_EQ(On(choice, Effect::kFriction), Decision::kExcluded);
  EXPECT_EQ(choice.neglected, PlanarSizes(problem, {})[Effect::kFriction].value);
  EXPECT_GT(choice.neglected, 1e-2);
  const Choice exact = ChoosePlanar(problem, {}, {.relative_tolerance = 0.0, .excluded = {Effect::kFriction}});
  EXPECT_EQ(exact.model, Model::kPlanar);
  EXPECT_EQ(Without(exact, problem).mu, 0.0);
}

TEST(ChooseTest, SlipThatIsNotToStopSlidesOn) {
  planar::Problem problem = Slider();
  problem.u0 = 0.1;
  problem.mu_static = 0.5;
  EXPECT_EQ(ChoosePlanar(problem, {}, {.relative_tolerance = 1e-3}).model, Model::kPlanar);
  const Choice choice =
      ChoosePlanar(problem, {.ratio_squared = 1.2}, {.relative_tolerance = 0.0, .excluded = {Effect::kSlipStop}});
  EXPECT_EQ(choice.model, Model::kSliding);
  EXPECT_EQ(On(choice, Effect::kSlipStop), Decision::kExcluded);
  EXPECT_EQ(On(choice, Effect::kTangentialCompliance), Decision::kExcluded);
  EXPECT_GT(choice.neglected, 0.01);
}

TEST(ChooseTest, StaticFrictionCanBeExcludedAlone) {
  planar::Problem problem = Slider();
  problem.u0 = -0.1;
  problem.w.tn = 0.4;
  problem.mu_static = 0.5;
  const Choice all = ChoosePlanar(problem, {}, {});
  EXPECT_EQ(all.model, Model::kPlanar);
  EXPECT_EQ(Without(all, problem).mu_static, 0.5);
  const Choice choice = ChoosePlanar(problem, {}, {.excluded = {Effect::kStaticFriction}});
  EXPECT_EQ(choice.model, Model::kPlanar);
  EXPECT_EQ(On(choice, Effect::kStaticFriction), Decision::kExcluded);
  EXPECT_EQ(Without(choice, problem).mu_static, 0.3);
}

TEST(ChooseTest, OnlyExactModelsServeAnInadmissibleRequestOrPossibleSelfLocking) {
  planar::Problem inadmissible = Slider();
  inadmissible.law = RestitutionLaw::kNewton;
  inadmissible.coefficient = 1.1;
  EXPECT_EQ(ChoosePlanar(inadmissible, {}, {.relative_tolerance = 0.1}).model, Model::kPlanar);
  planar::Problem jam = Slider();
  jam.w.tn = 0.9;
  jam.mu = jam.mu_static = 1.2;
  EXPECT_EQ(ChoosePlanar(jam, {}, {.relative_tolerance = 0.1}).model, Model::kPlanar);
}

TEST(ChooseTest, WhatSeparatesNeedsNoModel) {
  planar::Problem problem = Slider();
  problem.v0 = 0.5;
  EXPECT_EQ(ChoosePlanar(problem, {}, {}).model, Model::kNone);
  EXPECT_EQ(ChoosePlanar(problem, {.spring = LinearSpring{1e5}}, {}).model, Model::kNone);
  const ContactPhysics pressed = {.spring = LinearSpring{1e5}, .normal_acceleration = -9.81};
  EXPECT_EQ(ChoosePlanar(problem, pressed, {}).model, Model::kFiniteDuration);
  EXPECT_EQ(ChoosePlanar(problem, pressed, {.excluded = {Effect::kFiniteForces}}).model, Model::kNone);
}

TEST(ChooseTest, ASpringInTimeIsLeftOutUntilForcesOrTheCallerAskForIt) {
  const ContactPhysics spring = {.spring = LinearSpring{1e6}};
  const Choice alone = ChoosePlanar(Slider(), spring, {});
  EXPECT_EQ(alone.model, Model::kSliding);
  EXPECT_EQ(On(alone, Effect::kFiniteDuration), Decision::kNegligible);
  EXPECT_EQ(alone.neglected, 0.0);
  const Choice asked = ChoosePlanar(Slider(), spring, {.required = {Effect::kFiniteDuration}});
  EXPECT_EQ(asked.model, Model::kFiniteDuration);
  EXPECT_EQ(asked.model_tolerance, 1e-12);

  ContactPhysics pressed = spring;
  pressed.normal_acceleration = -9.81;
  const Choice rough = ChoosePlanar(Slider(), pressed, {.relative_tolerance = 0.1});
  EXPECT_EQ(rough.model, Model::kSliding);
  EXPECT_EQ(On(rough, Effect::kFiniteForces), Decision::kNegligible);
  EXPECT_GT(rough.neglected, 1e-3);
  const Choice fine = ChoosePlanar(Slider(), pressed, {.relative_tolerance = 1e-6});
  EXPECT_EQ(fine.model, Model::kFiniteDuration);
  EXPECT_EQ(fine.model_tolerance, 1e-6);
  const Choice without = ChoosePlanar(Slider(), pressed, {.excluded = {Effect::kFiniteDuration}});
  EXPECT_EQ(without.model, Model::kSliding);
  EXPECT_EQ(On(without, Effect::kFiniteForces), Decision::kExcluded);
  EXPECT_EQ(without.neglected, rough.neglected);
}

TEST(ChooseTest, DampingIsAlwaysSimulated) {
  const ContactPhysics damped = {.spring = HuntCrossleySpring{1e6, 1.5, 0.3}};
  const Choice choice = ChoosePlanar(Slider(), damped, {.relative_tolerance = 0.1});
  EXPECT_EQ(choice.model, Model::kFiniteDuration);
  EXPECT_EQ(On(choice, Effect::kFiniteDuration), Decision::kSimulated);
}

// The forms without friction and of first order cost more than the closed form and are less exact.
TEST(ChooseTest, APendulumWithFrictionIsAnsweredByItsClosedFormAtEveryTolerance) {
  const pendulum::Problem problem = {
      .inertia = 1.0, .a = 1.0, .b = 0.1, .omega_minus = -1.0, .mu = 0.1, .mu_static = 0.1, .coefficient = 0.5};
  for (const double tolerance : {0.1, 1e-3, 1e-6, 0.0}) {
    EXPECT_EQ(ChoosePendulum(problem, {}, {.relative_tolerance = tolerance}).model, Model::kPendulum);
  }
  EXPECT_EQ(ChoosePendulum(problem, {}, {.excluded = {Effect::kFriction}}).model, Model::kFrictionless);
  EXPECT_EQ(ChoosePendulum(problem, {}, {.required = {Effect::kHigherOrder}}).model, Model::kPendulum);
  const Choice forced = ChoosePendulum(problem, {}, {.excluded = {Effect::kHigherOrder}});
  EXPECT_EQ(forced.model, Model::kFirstOrder);
  EXPECT_NEAR(forced.neglected, 0.5e-4 / 4.0, 0.5e-4);
}

// Compliance changes no more than friction does.
TEST(ChooseTest, TheClosedFormAnswersACompliantPendulumWithLittleFriction) {
  const pendulum::Problem problem = {
      .inertia = 1.0, .a = 1.0, .b = 0.1, .omega_minus = -1.0, .mu = 0.01, .mu_static = 0.01, .coefficient = 0.5};
  const ContactPhysics physics = {.ratio_squared = 1.5};
  EXPECT_EQ(ChoosePendulum(problem, physics, {.relative_tolerance = 0.1}).model, Model::kPendulum);
  EXPECT_EQ(ChoosePendulum(problem, physics, {.relative_tolerance = 1e-6}).model, Model::kCompliant);
}

// With kappa = e (1 + x)/(1 - x) = 1 the impulses of friction in compression and in restitution cancel. Under Newton's
// law all velocities and total impulses are then those without friction, but the works are not.
TEST(ChooseTest, FrictionThatCancelsInTheEndIsSimulated) {
  const pendulum::Problem problem = {.inertia = 1.0,
                                     .a = 0.6,
                                     .b = 0.8,
                                     .omega_minus = -1.0,
                                     .mu = 0.375,
                                     .mu_static = 0.375,
                                     .law = RestitutionLaw::kNewton,
                                     .coefficient = 1.0 / 3.0};
  EXPECT_EQ(ChoosePendulum(problem, {}, {.relative_tolerance = 0.1}).model, Model::kPendulum);
  EXPECT_EQ(ModelOfPendulum(problem, 0.1), Model::kPendulum);
  // x = 1/2, and the change of Wtt f0 is (b/a) x/(1 + x).
  EXPECT_NEAR(PendulumFrictionSize(problem).value, 4.0 / 9.0, 1e-5);
}

TEST(ChooseTest, InSpaceTheModelIsGivenTheBudget) {
  spatial::Problem problem = TurningContact(1.0, 0.6, 0.4);
  problem.coefficient = 0.6;
  EXPECT_EQ(ChooseSpatial(problem, {.relative_tolerance = 1e-7}).model_tolerance, 1e-7);
  EXPECT_EQ(ChooseSpatial(problem, {.relative_tolerance = 1e-2}).model_tolerance, 1e-2);
  EXPECT_EQ(ChooseSpatial(problem, {.relative_tolerance = 0.0}).model_tolerance, 1e-12);
  const Choice straight = ChooseSpatial(problem, {.excluded = {Effect::kSlipTurn}});
  EXPECT_EQ(straight.model, Model::kSliding);
  EXPECT_EQ(straight.neglected, kUnbounded);
  problem.u0 = {10000.0, 6000.0};
  EXPECT_EQ(ChooseSpatial(problem, {.relative_tolerance = 1e-3}).model, Model::kSliding);
}

// An alumina sphere of 2.5 mm radius against a rough plate at 3.9 m/s: Kharaz, Gorham and Salman (2001).
planar::Problem KharazSphere(double degrees) {
  constexpr double kPerMass = 1.0;  // Velocities do not depend on it.
  const double radians = degrees * 3.14159265358979323846 / 180.0;
  return {.w = {3.5 * kPerMass, 0.0, kPerMass},
          .u0 = 3.9 * std::sin(radians),
          .v0 = -3.9 * std::cos(radians),
          .mu = 0.092,
          .mu_static = 0.092,
          .coefficient = 0.98};
}

TEST(ChooseTest, TheSphereOfKharazCallsForComplianceAt20DegreesAndDropsItAt60) {
  constexpr double kPoissonsRatio = 0.3;
  const ContactPhysics physics = {.ratio_squared = (2.0 - kPoissonsRatio) / (2.0 * (1.0 - kPoissonsRatio))};
  const Demand demand = {.relative_tolerance = 0.01};
  const Choice steep = ChoosePlanar(KharazSphere(20.0), physics, demand);
  EXPECT_EQ(steep.model, Model::kCompliant);
  EXPECT_EQ(On(steep, Effect::kTangentialCompliance), Decision::kSimulated);
  const Choice shallow = ChoosePlanar(KharazSphere(60.0), physics, demand);
  EXPECT_EQ(shallow.model, Model::kSliding);
  EXPECT_EQ(On(shallow, Effect::kTangentialCompliance), Decision::kAbsent);
  Plan plan;
  Explain(shallow, demand, plan);
  EXPECT_EQ(plan.effects.List()[4].reason, "the contact slides throughout");
}

}  // namespace
}  // namespace ricochet
