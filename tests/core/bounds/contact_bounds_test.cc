// Bounds of a planar contact: by hand, against the pendulum's, against impacts of every coefficient.

#include "core/bounds/contact_bounds.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <sstream>
#include <string>

#include "core/bounds/pendulum_bounds.h"
#include "core/models/restitution_law.h"
#include "tests/support/scenes/known_contacts.h"
#include "tests/support/scenes/pendulum_scenes.h"
#include "tests/support/scenes/planar_scenes.h"

namespace ricochet::planar {
namespace {

// A rod at 45 degrees, W = [[2.5, 1.5], [1.5, 2.5]], (u, v) = (-1, -1), mu = 0.7.
const Problem kRod = FortyFiveDegreeRod();
// Wtn drives slip on: u and Wtn have one sign.
const Problem kDriven = {.w = {1.0, 0.8, 1.0}, .u0 = 1.0, .v0 = -1.0, .mu = 1.0, .mu_static = 1.0};

Impact SolveAt(Problem problem, RestitutionLaw law, double coefficient) {
  problem.law = law;
  problem.coefficient = coefficient;
  return Solve(problem);
}

bool Within(const Range& range, double value) {
  const double slack = 4e-15 * std::max({std::fabs(range.lower), std::fabs(range.upper), std::fabs(value)});
  return value >= range.lower - slack && value <= range.upper + slack;
}

std::string ToString(const Problem& problem) {
  std::ostringstream text;
  text << std::hexfloat << "wtt " << problem.w.tt << " wtn " << problem.w.tn << " wnn " << problem.w.nn << " u0 "
       << problem.u0 << " v0 " << problem.v0 << " mu " << problem.mu << " mu_s " << problem.mu_static;
  return text.str();
}

// Slip falls at 3.25 and v grows at 3.55 a unit of impulse: slip stops at v = 3.55/3.25 - 1 = 6/65, after compression,
// and sticks, v' = 8/5. So v1^2 = (6/65)^2 + (8/5)/3.55 (1 - (6/65)^2).
TEST(ContactBoundsTest, RodByHand) {
  const Bounds bounds = SolveBounds(kRod);
  const double stop = 6.0 / 65.0;
  const double v1 = std::sqrt(stop * stop + 32.0 / 71.0 * (1.0 - stop * stop));
  const double tau1 = 1.0 / 3.25 + (v1 - stop) / 1.6;
  EXPECT_EQ(bounds.regime, Regime::kStickInRestitution);
  EXPECT_EQ(Solve(kRod).w_rank, 2);
  EXPECT_EQ(bounds.sharp.newton.lower, 0.0);
  EXPECT_NEAR(bounds.sharp.newton.upper, v1, 1e-15);
  EXPECT_NEAR(bounds.sharp.poisson.upper, 3.55 * tau1 - 1.0, 1e-15);
  EXPECT_EQ(bounds.sharp.energetic, (Range{0.0, 1.0}));
  EXPECT_NEAR(bounds.sharp.normal_total_n_s.lower, 1.0 / 3.55, 1e-16);
  EXPECT_NEAR(bounds.sharp.normal_total_n_s.upper, tau1, 1e-15);
  // Slip is towards -t: friction starts as +mu, then holds with -Wtn/Wtt.
  EXPECT_EQ(bounds.sharp.tangential.upper, 0.7);
  EXPECT_NEAR(bounds.sharp.tangential.lower, (0.7 / 3.25 - 0.6 * (tau1 - 1.0 / 3.25)) / tau1, 1e-15);
}

TEST(ContactBoundsTest, CriticalFrictionOfTheRodByHand) {
  const CriticalFriction critical = SolveBounds(kRod).critical;
  EXPECT_EQ(critical.stick, 0.6);
  EXPECT_EQ(critical.stop_compression, 1.0);  // (2.5 - 1.5)/(2.5 - 1.5)
  EXPECT_EQ(critical.stop, 0.0);              // (2.5 - 3)/(5 - 1.5) < 0: even a smooth rod turns its slip around.
  EXPECT_EQ(critical.reversal, 0.0);
  EXPECT_FALSE(critical.jam.has_value());
}

TEST(ContactBoundsTest, CriticalFrictionOfADrivenContactByHand) {
  const CriticalFriction critical = SolveBounds(kDriven).critical;
  EXPECT_EQ(critical.stick, 0.8);
  EXPECT_EQ(critical.stop_compression, 1.0);  // 1.8/1.8
  EXPECT_DOUBLE_EQ(critical.stop.value(), 2.6 / 2.8);
  EXPECT_FALSE(critical.reversal.has_value());
  EXPECT_EQ(critical.jam, 1.25);
}

TEST(ContactBoundsTest, NewtonAndPoissonMayExceedOneInAnAdmissibleImpact) {
  const Bounds driven = SolveBounds(kDriven);
  EXPECT_GT(driven.sharp.newton.upper, 1.0);
  EXPECT_FALSE(SolveAt(kDriven, RestitutionLaw::kNewton, driven.sharp.newton.upper).energy_limit_broken);
  EXPECT_GT(SolveBounds(kRod).sharp.poisson.upper, 1.0);
}

// ---- Rank one: the pendulum ----

void ExpectNear(const Range& got, const Range& want, double tolerance) {
  EXPECT_NEAR(got.lower, want.lower, tolerance * std::max(1e-3, std::fabs(want.lower)));
  EXPECT_NEAR(got.upper, want.upper, tolerance * std::max(1e-3, std::fabs(want.upper)));
}

void ExpectNear(const CoefficientBounds& got, const CoefficientBounds& want, double tolerance) {
  ExpectNear(got.newton, want.newton, tolerance);
  ExpectNear(got.poisson, want.poisson, tolerance);
  ExpectNear(got.energetic, want.energetic, tolerance);
  ExpectNear(got.tangential, want.tangential, tolerance);
  ExpectNear(got.normal_total_n_s, want.normal_total_n_s, tolerance);
}

TEST(ContactBoundsTest, RankOneIsThePendulum) {
  pendulum::SceneSource source(7);
  int slipping = 0;
  for (int i = 0; i < 20'000 && !HasFailure(); ++i) {
    const pendulum::Problem problem = source.Everyday();
    const Bounds want = pendulum::SolveBounds(problem);
    // Between the thresholds of the two frictions rounding of W decides nothing; near x = 1 it decides much.
    if (std::fabs(1.0 - want.friction_ratio) < 1e-3) continue;
    const Bounds got = SolveBounds(ContactOf(problem));
    ASSERT_EQ(Solve(ContactOf(problem)).w_rank, 1);
    ASSERT_EQ(got.regime == Regime::kLocked, want.regime == Regime::kLocked) << ToString(problem);
    const double tolerance = 1e-13 / std::fabs(1.0 - want.friction_ratio);
    ExpectNear(got.sharp, want.sharp, tolerance);
    ExpectNear(got.energy_only.value(), want.energy_only.value(), tolerance);
    const CriticalFriction& critical = want.critical;
    EXPECT_NEAR(got.critical.stick.value_or(0.0), critical.stick.value_or(0.0), 1e-13 * critical.stick.value_or(1.0));
    EXPECT_EQ(got.critical.stop_compression, critical.stop_compression);
    EXPECT_EQ(got.critical.stop, critical.stop);
    EXPECT_EQ(got.critical.reversal, critical.reversal);
    EXPECT_EQ(got.critical.jam, critical.jam);
    ASSERT_FALSE(::testing::Test::HasFailure()) << ToString(problem);
    slipping += want.regime != Regime::kLocked ? 1 : 0;
  }
  EXPECT_GT(slipping, 5'000);
}

TEST(ContactBoundsTest, LockedContactHasOneValueOfEverything) {
  const Bounds bounds = SolveBounds({.w = {16.0, 4.0, 1.0}, .u0 = -4.0, .v0 = -1.0, .mu = 0.5, .mu_static = 0.5});
  EXPECT_EQ(bounds.regime, Regime::kLocked);
  EXPECT_EQ(bounds.sharp.newton, Range());
  EXPECT_EQ(bounds.sharp.poisson, Range());
  EXPECT_EQ(bounds.sharp.energetic, Range());
  EXPECT_EQ(bounds.sharp.tangential, (Range{0.5, 0.5}));
  EXPECT_EQ(bounds.sharp.normal_total_n_s.lower, bounds.sharp.normal_total_n_s.upper);
  EXPECT_EQ(bounds.energy_only, bounds.sharp);
}

TEST(ContactBoundsTest, SeparatingContactHasNoImpulse) {
  Problem problem = kRod;
  problem.v0 = 0.0;
  const Bounds bounds = SolveBounds(problem);
  EXPECT_EQ(bounds.regime, Regime::kSeparating);
  EXPECT_EQ(bounds.sharp, CoefficientBounds());
}

// ---- Impacts of every coefficient ----

TEST(ContactBoundsTest, EveryAdmissibleImpactLiesWithin) {
  SceneSource source(11);
  for (int i = 0; i < 20'000; ++i) {
    const Problem problem = source.Any();
    const CoefficientBounds bounds = SolveBounds(problem).sharp;
    for (int k = 0; k < 9; ++k) {
      const Impact impact = SolveAt(problem, RestitutionLaw::kEnergetic, k / 8.0);
      ASSERT_TRUE(Within(bounds.newton, impact.newton)) << ToString(problem);
      ASSERT_TRUE(Within(bounds.poisson, impact.poisson)) << ToString(problem);
      ASSERT_TRUE(Within(bounds.energetic, impact.energetic)) << ToString(problem);
      ASSERT_TRUE(Within(bounds.tangential, impact.tangential)) << ToString(problem);
      ASSERT_TRUE(Within(bounds.normal_total_n_s, impact.tau1)) << ToString(problem);
    }
  }
}

TEST(ContactBoundsTest, TheBoundFedBackIsAdmissibleForEveryLaw) {
  SceneSource source(12);
  for (int i = 0; i < 50'000; ++i) {
    const Problem problem = source.Any();
    const CoefficientBounds bounds = SolveBounds(problem).sharp;
    ASSERT_FALSE(SolveAt(problem, RestitutionLaw::kNewton, bounds.newton.upper).sharp_limit_broken)
        << ToString(problem);
    ASSERT_FALSE(SolveAt(problem, RestitutionLaw::kPoisson, bounds.poisson.upper).sharp_limit_broken)
        << ToString(problem);
    ASSERT_FALSE(SolveAt(problem, RestitutionLaw::kEnergetic, bounds.energetic.upper).sharp_limit_broken)
        << ToString(problem);
  }
}

TEST(ContactBoundsTest, AboveTheBoundIsInadmissible) {
  SceneSource source(13);
  for (int i = 0; i < 20'000; ++i) {
    const Problem problem = source.Everyday();
    const Bounds bounds = SolveBounds(problem);
    ASSERT_TRUE(SolveAt(problem, RestitutionLaw::kNewton, 1.001 * bounds.sharp.newton.upper).sharp_limit_broken)
        << ToString(problem);
    ASSERT_TRUE(SolveAt(problem, RestitutionLaw::kPoisson, 1.001 * bounds.sharp.poisson.upper).sharp_limit_broken)
        << ToString(problem);
  }
}

// Poisson's law run to the energy's bound brings back the energy that was there, no more and no less.
TEST(ContactBoundsTest, EnergyIsBackWhereItsBoundSays) {
  SceneSource source(14);
  for (int i = 0; i < 20'000; ++i) {
    const Problem problem = source.Everyday();
    const Bounds bounds = SolveBounds(problem);
    if (problem.w.tt * problem.w.nn - problem.w.tn * problem.w.tn < 1e-3 * problem.w.tt * problem.w.nn) continue;
    const Impact impact = SolveAt(problem, RestitutionLaw::kPoisson, bounds.energy_only->poisson.upper);
    const double scale = impact.tau1 * (std::fabs(problem.v0) + impact.v1) +
                         std::fabs(impact.f1) * (std::fabs(problem.u0) + std::fabs(impact.u1));
    ASSERT_NEAR(impact.energy_change, 0.0, 1e-12 * scale) << ToString(problem);
    ASSERT_NEAR(impact.newton, bounds.energy_only->newton.upper, 1e-11 * (1.0 + impact.newton)) << ToString(problem);
    ASSERT_NEAR(impact.energetic, bounds.energy_only->energetic.upper, 1e-10 * impact.energetic) << ToString(problem);
    ASSERT_TRUE(Within(bounds.energy_only->newton, bounds.sharp.newton.upper)) << ToString(problem);
  }
}

// ---- Critical friction ----

bool Stops(const Problem& problem, double mu, bool in_compression) {
  Problem at = problem;
  at.mu = at.mu_static = mu;
  const Impact impact = SolveAt(at, RestitutionLaw::kEnergetic, 1.0);
  for (int i = 0; i < impact.event_count; ++i) {
    if (impact.events[static_cast<size_t>(i)].kind != EventKind::kSlipStops) continue;
    return !in_compression || impact.events[static_cast<size_t>(i)].tau < impact.tau_compression;
  }
  return false;
}

void ExpectThreshold(const Problem& problem, const std::optional<double>& critical, bool in_compression) {
  if (!critical) {
    EXPECT_FALSE(Stops(problem, 1e3, in_compression)) << ToString(problem);
    return;
  }
  EXPECT_TRUE(Stops(problem, *critical * 1.0001 + 1e-9, in_compression)) << ToString(problem);
  if (*critical < 1e-6) return;
  EXPECT_FALSE(Stops(problem, *critical * 0.9999, in_compression)) << ToString(problem);
}

TEST(ContactBoundsTest, SlipStopsFromTheCriticalFrictionOn) {
  SceneSource source(15);
  for (int i = 0; i < 5'000; ++i) {
    const Problem problem = source.Everyday();
    const CriticalFriction critical = SolveBounds(problem).critical;
    ExpectThreshold(problem, critical.stop_compression, true);
    ExpectThreshold(problem, critical.stop, false);
    ASSERT_FALSE(::testing::Test::HasFailure());
  }
}

TEST(ContactBoundsTest, SlipReversesBetweenTheCriticalFrictions) {
  SceneSource source(16);
  int reversals = 0;
  for (int i = 0; i < 5'000; ++i) {
    Problem problem = source.Everyday();
    const CriticalFriction critical = SolveBounds(problem).critical;
    if (!critical.reversal) continue;
    ++reversals;
    problem.mu = problem.mu_static = 0.5 * (*critical.reversal + *critical.stick);
    const Regime regime = SolveBounds(problem).regime;
    ASSERT_TRUE(regime == Regime::kReversalInCompression || regime == Regime::kReversalInRestitution)
        << ToString(problem);
  }
  EXPECT_GT(reversals, 1'000);
}

TEST(ContactBoundsTest, AboveTheJamSlidingDrivesTheContactIn) {
  Problem problem = kDriven;
  const auto v_where_slip_stops = [&](double mu) {
    problem.mu = problem.mu_static = mu;
    return SolveAt(problem, RestitutionLaw::kEnergetic, 1.0).events[1].v;
  };
  EXPECT_LT(v_where_slip_stops(1.26), problem.v0);
  EXPECT_GT(v_where_slip_stops(1.24), problem.v0);
}

}  // namespace
}  // namespace ricochet::planar
