// Plans as a caller sees them: through Solve, with the fields of a request.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/plan/scene_problem.h"
#include "ricochet/solver.h"
#include "tests/support/scenes/planar_scenes.h"
#include "tests/support/scenes/system_scenes.h"

namespace ricochet {
namespace {

using testing::ElementsAre;

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
                                    "= 8: must not be asked of a scene without a normal spring in compliance"}));
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

Outcome SolvedWithin(const planar::Problem& problem, double tolerance) {
  return Solved({.scene = SceneOf(problem), .demand = {.relative_tolerance = tolerance}});
}

// Checks the promise of SolveRequest.relative_tolerance against the impact with all its effects to double precision.
void CheckPromise(const planar::Problem& problem, const Outcome& outcome, const Outcome& exact) {
  const double d = (outcome.plan.relative_tolerance + 0x1p-48) * std::max(std::fabs(problem.u0), std::fabs(problem.v0));
  const double u1 = outcome.contact_velocity_after.tangential_m_s[0];
  const double v1 = outcome.contact_velocity_after.normal_m_s;
  const double f1 = exact.impulse.tangential_n_s[0];
  const double tau1 = exact.impulse.normal_total_n_s;
  const planar::Problem& p = problem;
  EXPECT_LE(std::fabs(u1 - exact.contact_velocity_after.tangential_m_s[0]), d);
  EXPECT_LE(std::fabs(v1 - exact.contact_velocity_after.normal_m_s), d);
  EXPECT_LE(std::fabs(outcome.impulse.normal_total_n_s - tau1) * p.w.nn, d);
  EXPECT_LE(std::fabs(outcome.impulse.tangential_n_s[0] - f1) * p.w.tt, d);
  EXPECT_LE(std::fabs(outcome.coefficients.newton - exact.coefficients.newton), d / std::fabs(p.v0));
  EXPECT_LE(std::fabs(outcome.coefficients.tangential - exact.coefficients.tangential),
            d * (1.0 / p.w.tt + std::fabs(exact.coefficients.tangential) / p.w.nn) / outcome.impulse.normal_total_n_s);
  EXPECT_LE(std::fabs(outcome.energy_change_j - exact.energy_change_j),
            0.5 * d * (std::fabs(f1) + tau1 + std::fabs(p.u0 + u1) / p.w.tt + std::fabs(p.v0 + v1) / p.w.nn));
}

void CheckError(const std::optional<double>& error, const std::optional<double>& exact_error, double number,
                double exact) {
  ASSERT_TRUE(error.has_value() && exact_error.has_value());
  EXPECT_LE(std::fabs(number - exact), (*error + *exact_error) * (1.0 + 1e-12));
}

// Checks the errors that are stated where effects are left out.
void CheckErrors(const Outcome& outcome, const Outcome& exact) {
  const NumberErrors& errors = outcome.errors;
  const NumberErrors& left = exact.errors;
  CheckError(errors.newton, left.newton, outcome.coefficients.newton, exact.coefficients.newton);
  CheckError(errors.tangential, left.tangential, outcome.coefficients.tangential, exact.coefficients.tangential);
  CheckError(errors.tangential_m_s, left.tangential_m_s, outcome.contact_velocity_after.tangential_m_s[0],
             exact.contact_velocity_after.tangential_m_s[0]);
  CheckError(errors.normal_m_s, left.normal_m_s, outcome.contact_velocity_after.normal_m_s,
             exact.contact_velocity_after.normal_m_s);
  CheckError(errors.tangential_n_s, left.tangential_n_s, outcome.impulse.tangential_n_s[0],
             exact.impulse.tangential_n_s[0]);
  CheckError(errors.normal_total_n_s, left.normal_total_n_s, outcome.impulse.normal_total_n_s,
             exact.impulse.normal_total_n_s);
  CheckError(errors.energy_change_j, left.energy_change_j, outcome.energy_change_j, exact.energy_change_j);
}

// The slip is 1e13 times the approach, and friction hardly changes it. It decides on the impulses and the energy.
TEST(PlannedSolveTest, FrictionOfAGrazingImpactIsNotLeftOut) {
  const planar::Problem problem = {
      .w = {2.5, 1.5, 2.5}, .u0 = 1.0, .v0 = -1e-13, .mu = 0.7, .mu_static = 0.7, .coefficient = 0.8};
  for (const double tolerance : {1e-2, 1e-6, 1e-12}) {
    const Outcome outcome = SolvedWithin(problem, tolerance);
    EXPECT_EQ(outcome.plan.neglected, 0.0);
    // The contact slides on, so that v' = Wnn - mu Wtn = 1.45 and f = -mu tau.
    const double tau1 = 1.8e-13 / 1.45;
    EXPECT_NEAR(outcome.impulse.normal_total_n_s, tau1, 1e-15 * tau1);
    EXPECT_NEAR(outcome.impulse.tangential_n_s[0], -0.7 * tau1, 1e-15 * tau1);
    EXPECT_NEAR(outcome.energy_change_j, -0.7 * tau1, 1e-12 * tau1);
  }
}

TEST(PlannedSolveTest, EveryNumberThatTheToleranceSpeaksOfKeepsItsPromise) {
  planar::SceneSource source(91);
  int with_effects_left_out = 0;
  int plain = 0;
  for (int i = 0; i < 4000 && !HasFailure(); ++i) {
    planar::Problem problem = source.Any();
    if (problem.v0 >= 0.0 || problem.w.tt == 0.0) continue;
    if (i % 2 == 0) problem.mu = problem.mu_static = problem.mu * 1e-3;  // Friction that may be left out.
    const Outcome exact = SolvedWithin(problem, 0.0);
    if (exact.regime == Regime::kWedged || exact.regime == Regime::kLocked) continue;
    for (const double tolerance : {0.1, 1e-2, 1e-4, 1e-8, 1e-12}) {
      const Outcome outcome = SolvedWithin(problem, tolerance);
      with_effects_left_out += outcome.plan.neglected > 0.0 ? 1 : 0;
      plain += outcome.plan.arithmetic.reason == ArithmeticReason::kWithinTolerance ? 1 : 0;
      if (outcome.accuracy.relative_error <= tolerance) CheckPromise(problem, outcome, exact);
      if (outcome.plan.neglected > 0.0) CheckErrors(outcome, exact);
    }
  }
  EXPECT_GT(with_effects_left_out, 500);
  EXPECT_GT(plain, 500);
}

TEST(PlannedSolveTest, WhatIsLeftOutIsWithinTheToleranceAndInTheErrorStated) {
  for (const System& system : Systems()) {
    for (const double tolerance : {0.1, 1e-2, 1e-4, 1e-8}) {
      const Outcome outcome = Solved({.scene = With(system), .demand = {.relative_tolerance = tolerance}});
      EXPECT_LE(outcome.plan.neglected, tolerance);
      EXPECT_LE(outcome.accuracy.relative_error, tolerance);
      const ContactVelocity& before = outcome.timeline.front().state.contact_velocity;
      double speed = std::fabs(before.normal_m_s);
      for (const double u : before.tangential_m_s) speed = std::max(speed, std::fabs(u));
      EXPECT_GE(outcome.accuracy.relative_error,
                outcome.plan.neglected * (std::fabs(before.normal_m_s) / speed) * (1.0 - 0x1p-50));
    }
  }
}

}  // namespace
}  // namespace ricochet
