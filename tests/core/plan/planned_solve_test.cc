// Plans as a caller sees them: through Solve, with the fields of a request.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "ricochet/solver.h"
#include "tests/support/system_scenes.h"

namespace ricochet {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

Outcome Solved(const SolveRequest& request) {
  const absl::StatusOr<SolveResponse> response = LocalSolver().Solve(request);
  EXPECT_TRUE(response.ok()) << response.status();
  return response.ok() ? response->outcome : Outcome();
}

std::vector<Violation> Refused(const SolveRequest& request) {
  const absl::StatusOr<SolveResponse> response = LocalSolver().Solve(request);
  EXPECT_EQ(response.status().code(), absl::StatusCode::kInvalidArgument);
  return ViolationsOf(response.status());
}

Scene OnASpring(const System& system, const FiniteForces& forces) {
  Scene scene = With(system);
  scene.compliance = {.tangential_ratio_squared = {}, .normal = LinearSpring{1e4}};
  scene.finite_forces = forces;
  return scene;
}

TEST(PlannedSolveTest, ThePlanAloneIsThatOfTheSolve) {
  for (const System& system : Systems()) {
    for (const double tolerance : {0.1, 1e-3, 1e-9}) {
      const SolveRequest request{.scene = With(system), .demand = {.relative_tolerance = tolerance}};
      const Plan plan = Solved(request).plan;
      EXPECT_EQ(plan.relative_tolerance, tolerance);
      EXPECT_EQ(plan.effects.List().size(), static_cast<size_t>(kEffectCount - 1));
      const auto planned = LocalSolver().Plan({.scene = request.scene, .demand = request.demand});
      ASSERT_TRUE(planned.ok()) << planned.status();
      EXPECT_EQ(planned->plan, plan);
    }
  }
}

TEST(PlannedSolveTest, ForcesAreSampledAtEqualStepsOfTimeUntilTheLastTouch) {
  const Outcome outcome = Solved({.scene = OnASpring(Contact(), {}), .force_intervals = 8});
  EXPECT_EQ(outcome.plan.model, Model::kFiniteDuration);
  ASSERT_TRUE(outcome.contact.has_value());
  const std::vector<ForceSample>& history = outcome.contact->history;
  ASSERT_EQ(history.size(), 9U);
  for (size_t i = 0; i < history.size(); ++i) {
    EXPECT_NEAR(history[i].time_s, outcome.contact->duration_s * static_cast<double>(i) / 8.0, 1e-12);
    EXPECT_LE(history[i].normal_n, outcome.contact->peak_normal_n * (1.0 + 1e-9));
  }
}

TEST(PlannedSolveTest, ForcesNeedASpring) {
  EXPECT_THAT(Refused({.scene = With(Contact()), .force_intervals = 8}),
              ElementsAre(Violation{"force_intervals",
                                    "= 8: needs finite_duration, which must not be required of a scene without a "
                                    "normal spring in compliance"}));
  EXPECT_THAT(Refused({.scene = OnASpring(Contact(), {}), .force_intervals = -1}),
              ElementsAre(Violation{"force_intervals", "= -1: must be in [0, 65535]"}));
}

TEST(PlannedSolveTest, ListsOfEffectsNameEachOnce) {
  const DemandFields demand = {.required = {Effect::kFriction, Effect::kUnspecified},
                               .excluded = {Effect::kSlipStop, Effect::kSlipStop}};
  EXPECT_THAT(Refused({.scene = With(Contact()), .demand = demand}),
              ElementsAre(Violation{"required[1]", "= unspecified: must be an effect that is named"},
                          Violation{"excluded[1]", "= slip_stop: must be named once"}));
}

TEST(PlannedSolveTest, AnExcludedEffectIsLeftOutAndItsSizeTold) {
  const Outcome outcome = Solved({.scene = With(Contact()), .demand = {.excluded = {Effect::kFriction}}});
  EXPECT_EQ(outcome.plan.model, Model::kFrictionless);
  EXPECT_THAT(outcome.impulse.tangential_n_s, ElementsAre(0.0));
  const PlannedEffect friction = outcome.plan.effects.List().front();
  EXPECT_EQ(friction.decision, Decision::kExcluded);
  EXPECT_GT(friction.size, 0.1);
  EXPECT_EQ(outcome.plan.neglected, friction.size);
}

// The rates of the joints after an impact with finite forces give the tip the velocity of the contact's own equations:
// q'+ and (u1, v1) come from different integrals.
TEST(PlannedSolveTest, RatesAfterAnImpactThatTakesTimeMoveTheContactAsItMoves) {
  const DemandFields demand = {.relative_tolerance = 1e-9, .required = {Effect::kFiniteDuration}};
  const Pendulum pendulum = {2.0, 0.7, 0.4, -1.5};
  const Outcome swing = Solved({.scene = OnASpring(pendulum, PinMoment{-6.0}), .demand = demand});
  ASSERT_TRUE(swing.contact.has_value());
  EXPECT_NEAR(swing.contact_velocity_after.normal_m_s, pendulum.a_m * swing.rates_after_rad_s[0], 1e-8);
  EXPECT_NEAR(swing.contact_velocity_after.tangential_m_s[0], pendulum.b_m * swing.rates_after_rad_s[0], 1e-8);

  const Linkage chain = Chain();
  const Outcome whip = Solved({.scene = OnASpring(chain, Gravity{1.0, -9.81}), .demand = demand});
  ASSERT_TRUE(whip.contact.has_value());
  double u = 0.0;
  double v = 0.0;
  for (size_t i = 0; i < chain.links.size(); ++i) {
    u += chain.links[i].length_m * std::cos(chain.links[i].theta_rad) * whip.rates_after_rad_s[i];
    v += chain.links[i].length_m * std::sin(chain.links[i].theta_rad) * whip.rates_after_rad_s[i];
  }
  EXPECT_NEAR(whip.contact_velocity_after.tangential_m_s[0], u, 1e-8);
  EXPECT_NEAR(whip.contact_velocity_after.normal_m_s, v, 1e-8);
}

TEST(PlannedSolveTest, WhatIsLeftOutIsWithinTheToleranceAndInTheErrorStated) {
  for (const System& system : Systems()) {
    for (const double tolerance : {0.1, 1e-2, 1e-4, 1e-8}) {
      const Outcome outcome = Solved({.scene = With(system), .demand = {.relative_tolerance = tolerance}});
      EXPECT_LE(outcome.plan.neglected, tolerance);
      EXPECT_LE(outcome.accuracy.relative_error, tolerance);
      EXPECT_GE(outcome.accuracy.relative_error, outcome.plan.neglected);
    }
  }
}

}  // namespace
}  // namespace ricochet
