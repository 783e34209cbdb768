// The planar model: numbers by hand, every regime, the laws' limits, symmetries, and the pendulum as its rank-one case.

#include "core/models/planar/planar.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <vector>

#include "core/models/pendulum/pendulum.h"
#include "core/models/restitution_law.h"
#include "hwy/targets.h"
#include "tests/support/only_target.h"
#include "tests/support/oracles/planar_oracle.h"
#include "tests/support/oracles/ulp.h"
#include "tests/support/scenes/known_contacts.h"
#include "tests/support/scenes/planar_scenes.h"

namespace ricochet::planar {
namespace {

constexpr int kScenes = 100'000;

Problem Contact(double wtt, double wtn, double wnn, double u0, double mu, double mu_static, RestitutionLaw law,
                double coefficient) {
  return {.w = {wtt, wtn, wnn},
          .u0 = u0,
          .v0 = -1.0,
          .mu = mu,
          .mu_static = mu_static,
          .law = law,
          .coefficient = coefficient};
}

std::vector<EventKind> KindsOf(const Impact& impact) {
  std::vector<EventKind> kinds;
  for (int i = 0; i < impact.event_count; ++i) kinds.push_back(impact.events[static_cast<size_t>(i)].kind);
  return kinds;
}

std::vector<double> NumbersOf(const Impact& impact) {
  std::vector<double> numbers = {impact.newton,
                                 impact.poisson,
                                 impact.energetic,
                                 impact.energetic_excess,
                                 impact.v1,
                                 impact.tau_compression,
                                 impact.tau1,
                                 impact.work_normal_compression,
                                 impact.work_normal_restitution,
                                 impact.work_tangential_compression,
                                 impact.work_tangential_restitution,
                                 impact.energy_change,
                                 impact.tangential,
                                 impact.u1,
                                 impact.f_compression,
                                 impact.f1};
  for (int i = 0; i < impact.event_count; ++i) {
    const Instant& event = impact.events[static_cast<size_t>(i)];
    numbers.insert(numbers.end(), {event.tau, event.v, event.f, event.u});
  }
  return numbers;
}

double SumOfWorks(const Impact& impact) {
  return impact.work_normal_compression + impact.work_normal_restitution + impact.work_tangential_compression +
         impact.work_tangential_restitution;
}

double LargestWork(const Impact& impact) {
  return std::max({-impact.work_normal_compression, impact.work_normal_restitution, -impact.work_tangential_compression,
                   -impact.work_tangential_restitution});
}

// ---- By hand ----

// Slip -1 + 3.25 tau and v = -1 + 3.55 tau: compression ends at 20/71, slip stops at 4/13 with v = 6/65, and sticks,
// for 1.5 < 0.7 2.5; then v' = 4/2.5 = 1.6.
TEST(PlanarRodTest, NewtonsLawCreatesASixteenthOfAJoule) {
  const Impact impact = Solve(FortyFiveDegreeRod(RestitutionLaw::kNewton, 1.0));
  EXPECT_EQ(impact.regime, Regime::kStickInRestitution);
  EXPECT_EQ(impact.w_rank, 2);
  EXPECT_EQ(impact.v1, 1.0);
  EXPECT_EQ(impact.u1, 0.0);
  EXPECT_NEAR(impact.tau_compression, 20.0 / 71.0, 1e-15);
  EXPECT_NEAR(impact.events[2].tau, 4.0 / 13.0, 1e-15);
  EXPECT_NEAR(impact.events[2].v, 6.0 / 65.0, 1e-15);
  EXPECT_NEAR(impact.tau1, 4.0 / 13.0 + 59.0 / 65.0 / 1.6, 1e-15);
  EXPECT_NEAR(impact.energy_change, 1.0 / 16.0, 1e-15);
  EXPECT_TRUE(impact.energy_limit_broken);
  EXPECT_TRUE(impact.sharp_limit_broken);
  EXPECT_GT(impact.energetic, 1.0);
}

TEST(PlanarRodTest, PoissonsLawDoublesTheImpulseOfCompression) {
  const Impact impact = Solve(FortyFiveDegreeRod(RestitutionLaw::kPoisson, 1.0));
  EXPECT_NEAR(impact.tau1, 40.0 / 71.0, 1e-15);
  EXPECT_NEAR(impact.v1, 6.0 / 65.0 + 1.6 * (40.0 / 71.0 - 4.0 / 13.0), 1e-15);
  EXPECT_LT(impact.energy_change, 0.0);
  EXPECT_FALSE(impact.energy_limit_broken);
  EXPECT_FALSE(impact.sharp_limit_broken);
}

// Only friction takes energy: 0.7/2 4/13.
TEST(PlanarRodTest, EnergeticLawLosesSevenSixtyFifthsOfAJoule) {
  const Impact impact = Solve(FortyFiveDegreeRod(RestitutionLaw::kEnergetic, 1.0));
  EXPECT_NEAR(impact.energy_change, -7.0 / 65.0, 1e-15);
  EXPECT_NEAR(impact.work_tangential_compression + impact.work_tangential_restitution, -7.0 / 65.0, 1e-15);
  EXPECT_NEAR(impact.work_normal_compression, -10.0 / 71.0, 1e-15);
  EXPECT_EQ(impact.work_normal_restitution, -impact.work_normal_compression);
  EXPECT_FALSE(impact.energy_limit_broken);
  EXPECT_FALSE(impact.sharp_limit_broken);
  EXPECT_EQ(impact.energetic_excess, 0.0);
}

// v' = 1 - 1.5 < 0: v falls to -4/3 until slip stops at 2/3; stuck, v' = (3 - 2.25)/3 = 1/4.
TEST(PlanarSelfLockingTest, CompressionGoesOnUntilSlipHasStopped) {
  const Impact impact = Solve(Contact(3.0, 1.5, 1.0, 1.0, 1.0, 1.0, RestitutionLaw::kPoisson, 0.5));
  EXPECT_EQ(impact.regime, Regime::kStickInCompression);
  EXPECT_NEAR(impact.events[1].tau, 2.0 / 3.0, 1e-15);
  EXPECT_NEAR(impact.events[1].v, -4.0 / 3.0, 1e-15);
  EXPECT_NEAR(impact.tau_compression, 6.0, 1e-14);
  EXPECT_NEAR(impact.tau1, 9.0, 1e-14);
  EXPECT_NEAR(impact.v1, 0.75, 1e-15);
  EXPECT_EQ(impact.u1, 0.0);
}

// v' = 0 exactly while the contact slips: v stays constant.
TEST(PlanarSelfLockingTest, CompressionEndsAlsoIfVStandsStillWhileTheContactSlips) {
  const Impact impact = Solve(Contact(4.0, 1.0, 1.0, 3.0, 1.0, 1.0, RestitutionLaw::kNewton, 0.5));
  EXPECT_EQ(impact.events[1].tau, 1.0);
  EXPECT_EQ(impact.events[1].v, -1.0);
  EXPECT_NEAR(impact.tau_compression, 1.0 + 4.0 / 3.0, 1e-15);
  EXPECT_EQ(impact.v1, 0.5);
}

// s = 1, u' = 1.5 - 2.5 = -1, v' = 2.5 - 1.5 = 1: after slip has stopped v rises faster, 1.6, than in compression.
TEST(PlanarTest, PoissonsLawMayImplyASpringThatGivesBackMoreThanItStoredWithoutAGainOfEnergy) {
  const Impact impact = Solve(Contact(2.5, 1.5, 2.5, 1.5, 1.0, 1.0, RestitutionLaw::kPoisson, 1.0));
  EXPECT_EQ(impact.regime, Regime::kStickInRestitution);
  EXPECT_NEAR(impact.v1, 1.3, 1e-15);
  EXPECT_NEAR(impact.work_normal_restitution, 0.575, 1e-15);
  EXPECT_NEAR(impact.energetic, std::sqrt(1.15), 1e-15);
  EXPECT_NEAR(impact.energetic_excess, std::sqrt(1.15) - 1.0, 1e-15);
  EXPECT_TRUE(impact.sharp_limit_broken);
  EXPECT_LT(impact.energy_change, 0.0);
  EXPECT_FALSE(impact.energy_limit_broken);
}

TEST(PlanarTest, NoLawRestoresAnythingIfItsCoefficientIsZero) {
  for (const RestitutionLaw law : {RestitutionLaw::kNewton, RestitutionLaw::kPoisson, RestitutionLaw::kEnergetic}) {
    const Impact impact = Solve(FortyFiveDegreeRod(law, 0.0));
    EXPECT_EQ(impact.v1, 0.0);
    EXPECT_EQ(impact.tau1, impact.tau_compression);
    EXPECT_EQ(impact.newton, 0.0);
    EXPECT_EQ(impact.poisson, 0.0);
    EXPECT_EQ(impact.energetic, 0.0);
    EXPECT_EQ(impact.work_normal_restitution, 0.0);
    EXPECT_EQ(impact.energetic_excess, -1.0);
  }
}

// A disk: Wtn = 0.
TEST(PlanarTest, WithoutCouplingTheThreeLawsAgreeWhateverFrictionDoes) {
  for (const double u0 : {0.0, 0.5, -2.0, 20.0}) {
    const Impact newton = Solve(Contact(3.0, 0.0, 1.0, u0, 0.3, 0.3, RestitutionLaw::kNewton, 0.6));
    for (const RestitutionLaw law : {RestitutionLaw::kPoisson, RestitutionLaw::kEnergetic}) {
      const Impact impact = Solve(Contact(3.0, 0.0, 1.0, u0, 0.3, 0.3, law, 0.6));
      EXPECT_EQ(NumbersOf(impact), NumbersOf(newton)) << u0;
    }
  }
}

// ---- Regimes ----

struct RegimeCase {
  const char* reason;
  Problem problem;
  Regime regime;
  int events;
};

std::vector<RegimeCase> RegimeCases() {
  const RestitutionLaw law = RestitutionLaw::kEnergetic;
  Problem separating = FortyFiveDegreeRod(law, 0.5);
  separating.v0 = 1.0;
  Problem grazing = FortyFiveDegreeRod(law, 0.5);
  grazing.v0 = 0.0;
  return {
      {"v0 > 0", separating, Regime::kSeparating, 0},
      {"v0 = 0", grazing, Regime::kSeparating, 0},
      {"fast slip", Contact(3.0, 0.5, 1.0, 9.0, 0.3, 0.3, law, 0.5), Regime::kSliding, 3},
      {"slip that grows", Contact(1.0, 0.8, 1.0, 0.5, 0.3, 0.3, law, 0.5), Regime::kSliding, 3},
      {"slip that starts from 0", Contact(1.0, 0.8, 1.0, 0.0, 0.3, 0.3, law, 0.5), Regime::kSliding, 3},
      {"slow slip, strong friction", Contact(3.0, 0.5, 1.0, 0.1, 0.9, 0.9, law, 0.5), Regime::kStickInCompression, 4},
      {"no slip, strong friction", Contact(3.0, 0.5, 1.0, 0.0, 0.9, 0.9, law, 0.5), Regime::kStickInCompression, 3},
      {"|Wtn| = mu Wtt holds", Contact(4.0, 1.0, 1.0, 0.0, 0.25, 0.25, law, 0.5), Regime::kStickInCompression, 3},
      {"stops after v = 0", FortyFiveDegreeRod(law, 1.0), Regime::kStickInRestitution, 4},
      {"stops exactly at v = 0", Contact(4.0, 0.0, 1.0, 2.0, 0.5, 0.5, law, 0.5), Regime::kStickInRestitution, 4},
      {"stops exactly at the end", Contact(4.0, 0.0, 1.0, 3.0, 0.5, 0.5, law, 0.5), Regime::kStickInRestitution, 4},
      {"weak friction, slow", Contact(1.0, 0.8, 1.0, -0.2, 0.3, 0.3, law, 0.5), Regime::kReversalInCompression, 4},
      {"weak friction, fast", Contact(1.0, 0.8, 1.0, -1.1, 0.3, 0.3, law, 0.5), Regime::kReversalInRestitution, 4},
      {"static friction holds", Contact(1.0, 0.8, 1.0, -0.2, 0.3, 0.9, law, 0.5), Regime::kStickInCompression, 4},
      {"static friction holds from 0", Contact(1.0, 0.8, 1.0, 0.0, 0.3, 0.9, law, 0.5), Regime::kStickInCompression, 3},
      {"static friction alone", Contact(1.0, 0.8, 1.0, -0.2, 0.0, 0.9, law, 0.5), Regime::kStickInCompression, 4},
      {"mu = 0", Contact(1.0, 0.8, 1.0, -0.2, 0.0, 0.0, law, 0.5), Regime::kFrictionless, 4},
      {"mu = 0 and static friction too late", Contact(1.0, 0.1, 1.0, -9.0, 0.0, 0.9, law, 0.5), Regime::kFrictionless,
       3},
      {"Wtt = 0", Contact(0.0, 0.0, 1.0, 0.0, 0.5, 0.5, law, 0.5), Regime::kFrictionless, 3},
      {"a pendulum, x = 2", Contact(4.0, 2.0, 1.0, -2.0, 1.0, 1.0, law, 0.5), Regime::kLocked, 3},
      {"a pendulum, x = 1", Contact(4.0, 2.0, 1.0, -2.0, 0.5, 0.5, law, 0.5), Regime::kLocked, 3},
      {"a pendulum that static friction locks", Contact(4.0, 2.0, 1.0, -2.0, 0.25, 0.5, law, 0.5), Regime::kLocked, 3},
      {"a pendulum, x = 1/2", Contact(4.0, 2.0, 1.0, -2.0, 0.25, 0.25, law, 0.5), Regime::kReversalInRestitution, 4},
  };
}

TEST(PlanarTest, EveryRegimeIsReachedByItsCases) {
  for (const RegimeCase& c : RegimeCases()) {
    const Impact impact = Solve(c.problem);
    EXPECT_EQ(impact.regime, c.regime) << c.reason;
    EXPECT_EQ(impact.event_count, c.events) << c.reason;
  }
}

TEST(PlanarTest, SeparatingContactsKeepTheirVelocitiesAndGetNoImpulse) {
  for (const double v0 : {0.0, 2.0}) {
    Problem problem = FortyFiveDegreeRod(RestitutionLaw::kNewton, 0.5);
    problem.v0 = v0;
    const Impact impact = Solve(problem);
    EXPECT_EQ(impact.u1, -1.0);
    EXPECT_EQ(impact.v1, v0);
    EXPECT_EQ(impact.tau1, 0.0);
    EXPECT_EQ(impact.energy_change, 0.0);
    EXPECT_FALSE(impact.sharp_limit_broken);
    EXPECT_FALSE(impact.energy_limit_broken);
    EXPECT_EQ(At(problem, impact, 0.0).u, -1.0);
  }
}

TEST(PlanarTest, LockedContactsStopAndUseNoCoefficient) {
  for (const RestitutionLaw law : {RestitutionLaw::kNewton, RestitutionLaw::kPoisson, RestitutionLaw::kEnergetic}) {
    const Impact impact = Solve(Contact(4.0, 2.0, 1.0, -2.0, 1.0, 1.0, law, 0.5));
    EXPECT_EQ(impact.w_rank, 1);
    EXPECT_EQ(impact.u1, 0.0);
    EXPECT_EQ(impact.v1, 0.0);
    EXPECT_NEAR(impact.tau1, 1.0 / 3.0, 1e-16);
    EXPECT_EQ(impact.tau1, impact.tau_compression);
    EXPECT_NEAR(impact.f1, 1.0 / 3.0, 1e-16);
    EXPECT_EQ(impact.newton, 0.0);
    EXPECT_EQ(impact.poisson, 0.0);
    EXPECT_EQ(impact.energetic, 0.0);
    EXPECT_NEAR(impact.energy_change, -0.5, 1e-16);
    EXPECT_EQ(KindsOf(impact),
              (std::vector<EventKind>{EventKind::kStart, EventKind::kSlipStops, EventKind::kCompressionEnds}));
  }
}

// If Wtt = 0, no impulse moves the contact along t, and no friction impulse acts.
TEST(PlanarTest, ContactsWithoutTangentialMobilityGetNoFriction) {
  const Impact impact = Solve(Contact(0.0, 0.0, 2.0, 0.0, 0.5, 0.5, RestitutionLaw::kPoisson, 0.5));
  EXPECT_EQ(impact.w_rank, 1);
  EXPECT_EQ(impact.u1, 0.0);
  EXPECT_EQ(impact.f1, 0.0);
  EXPECT_EQ(impact.v1, 0.5);
  EXPECT_EQ(impact.tau1, 0.75);
}

TEST(PlanarTest, SlipThatStopsWhereCompressionEndsStopsFirst) {
  const Impact impact = Solve(Contact(4.0, 0.0, 1.0, 2.0, 0.5, 0.5, RestitutionLaw::kEnergetic, 0.5));
  EXPECT_EQ(KindsOf(impact), (std::vector<EventKind>{EventKind::kStart, EventKind::kSlipStops,
                                                     EventKind::kCompressionEnds, EventKind::kRestitutionEnds}));
}

// ---- Properties of random impacts ----

TEST(PlanarPropertyTest, EnergyNeverRisesUnderTheEnergeticLaw) {
  SceneSource source(1);
  for (int i = 0; i < kScenes; ++i) {
    Problem problem = i % 8 == 0 ? source.OverAllDoubles() : source.Any();
    problem.law = RestitutionLaw::kEnergetic;
    problem.coefficient = i % 3 == 0 ? 1.0 : std::min(problem.coefficient, 1.0);
    const Impact impact = Solve(problem);
    ASSERT_LE(impact.energy_change, 0.0) << ToString(problem);
    ASSERT_FALSE(impact.energy_limit_broken) << ToString(problem);
    ASSERT_FALSE(impact.sharp_limit_broken) << ToString(problem);
  }
}

TEST(PlanarPropertyTest, WorksAddUpToTheEnergyThatImpulsesAndVelocitiesGive) {
  SceneSource source(2);
  for (int i = 0; i < kScenes; ++i) {
    const Problem problem = source.Any();
    const Impact impact = Solve(problem);
    ASSERT_LE(std::fabs(SumOfWorks(impact) - impact.energy_change), 0x1p-50 * LargestWork(impact)) << ToString(problem);
  }
}

TEST(PlanarPropertyTest, FlagsAndExcessAgree) {
  SceneSource source(3);
  int sharp = 0;
  int energy = 0;
  for (int i = 0; i < kScenes; ++i) {
    const Problem problem = i % 8 == 0 ? source.OverAllDoubles() : source.Any();
    const Impact impact = Solve(problem);
    ASSERT_EQ(impact.sharp_limit_broken, impact.energetic_excess > 0.0) << ToString(problem);
    if (impact.energy_change > 0.0) {
      ASSERT_TRUE(impact.energy_limit_broken) << ToString(problem);
    }
    sharp += impact.sharp_limit_broken;
    energy += impact.energy_limit_broken;
  }
  EXPECT_GT(sharp, kScenes / 50);
  EXPECT_GT(energy, kScenes / 100);
}

// The friction impulse of each piece, up to the rounding of its ends.
void ExpectInsideCone(const Problem& problem, const Impact& impact) {
  for (int i = 1; i < impact.event_count; ++i) {
    const Instant& from = impact.events[static_cast<size_t>(i - 1)];
    const Instant& to = impact.events[static_cast<size_t>(i)];
    const bool sticks = from.u == 0.0 && to.u == 0.0;
    const double mu = sticks ? problem.mu_static : problem.mu;
    const double rounding = 0x1p-51 * (std::fabs(from.f) + std::fabs(to.f) + mu * to.tau) + 0x1p-1070;
    ASSERT_LE(std::fabs(to.f - from.f), mu * (to.tau - from.tau) + rounding) << ToString(problem);
    if (!sticks) {
      ASSERT_LE((to.f - from.f) * (from.u + to.u), 0.0) << "friction drives: " << ToString(problem);
    }
  }
}

TEST(PlanarPropertyTest, FrictionStaysInsideTheConeAlongThePath) {
  SceneSource source(4);
  for (int i = 0; i < kScenes && !HasFailure(); ++i) {
    const Problem problem = source.Any();
    ExpectInsideCone(problem, Solve(problem));
  }
}

TEST(PlanarPropertyTest, EveryImpactEndsFiniteWithEventsInOrderAndTheContactNoLongerApproaching) {
  SceneSource source(5);
  for (int i = 0; i < kScenes; ++i) {
    const Problem problem = source.Any();
    const Impact impact = Solve(problem);
    for (const double number : NumbersOf(impact)) ASSERT_TRUE(std::isfinite(number)) << ToString(problem);
    ASSERT_GE(impact.v1, 0.0) << ToString(problem);
    ASSERT_GE(impact.tau1, impact.tau_compression) << ToString(problem);
    ASSERT_GT(impact.tau_compression, 0.0) << ToString(problem);
    for (int k = 1; k < impact.event_count; ++k) {
      ASSERT_GE(impact.events[static_cast<size_t>(k)].tau, impact.events[static_cast<size_t>(k - 1)].tau);
    }
    const Instant& last = impact.events[static_cast<size_t>(impact.event_count - 1)];
    ASSERT_EQ(last.u, impact.u1);
    ASSERT_EQ(last.v, impact.v1);
    ASSERT_EQ(last.tau, impact.tau1);
    ASSERT_EQ(last.f, impact.f1);
  }
}

TEST(PlanarPropertyTest, NoImpactOverAllDoublesGivesANaN) {
  SceneSource source(6);
  for (int i = 0; i < kScenes; ++i) {
    const Problem problem = source.OverAllDoubles();
    for (const double number : NumbersOf(Solve(problem))) ASSERT_FALSE(std::isnan(number)) << ToString(problem);
  }
}

TEST(PlanarPropertyTest, NewtonsLawGivesItsVelocityExactlyAndStickExactlyNoSlip) {
  SceneSource source(7);
  for (int i = 0; i < kScenes; ++i) {
    const Problem problem = source.Any();
    const Impact impact = Solve(problem);
    const bool sticks = impact.regime == Regime::kStickInCompression || impact.regime == Regime::kStickInRestitution;
    if (problem.law == RestitutionLaw::kNewton && impact.regime != Regime::kLocked) {
      ASSERT_EQ(impact.v1, -problem.coefficient * problem.v0) << ToString(problem);
    }
    if (sticks || impact.regime == Regime::kLocked) {
      ASSERT_EQ(impact.u1, 0.0) << ToString(problem);
    }
  }
}

// ---- Symmetries ----

TEST(PlanarSymmetryTest, MirroringTheTangentMirrorsTheOutcomeBitByBit) {
  SceneSource source(8);
  for (int i = 0; i < kScenes; ++i) {
    const Problem problem = source.Any();
    Problem mirrored = problem;
    mirrored.u0 = -problem.u0;
    mirrored.w.tn = -problem.w.tn;
    Impact expected = Solve(problem);
    for (double* value : {&expected.u1, &expected.f1, &expected.f_compression, &expected.tangential}) *value = -*value;
    for (Instant& event : expected.events) {
      event.u = -event.u;
      event.f = -event.f;
    }
    const Impact impact = Solve(mirrored);
    ASSERT_EQ(impact.regime, expected.regime) << ToString(problem);
    ASSERT_EQ(NumbersOf(impact), NumbersOf(expected)) << ToString(problem);
  }
}

// W is scaled by 2^w, velocities by 2^s and the unit of u by 2^t, so far that DoubleDouble arithmetic cannot be used.
Problem Scaled(const Problem& problem, int w, int s, int t) {
  Problem scaled = problem;
  scaled.w.tt = std::ldexp(problem.w.tt, w + 2 * t);
  scaled.w.tn = std::ldexp(problem.w.tn, w + t);
  scaled.w.nn = std::ldexp(problem.w.nn, w);
  scaled.u0 = std::ldexp(problem.u0, s + t);
  scaled.v0 = std::ldexp(problem.v0, s);
  scaled.mu = std::ldexp(problem.mu, -t);
  scaled.mu_static = std::ldexp(problem.mu_static, -t);
  return scaled;
}

void ScaleBack(int w, int s, int t, Impact& impact) {
  const auto scale = [](double& value, int exponent) { value = std::ldexp(value, exponent); };
  for (double* work :
       {&impact.work_normal_compression, &impact.work_normal_restitution, &impact.work_tangential_compression,
        &impact.work_tangential_restitution, &impact.energy_change}) {
    scale(*work, w - 2 * s);
  }
  scale(impact.tau_compression, w - s);
  scale(impact.tau1, w - s);
  scale(impact.f_compression, w - s + t);
  scale(impact.f1, w - s + t);
  scale(impact.tangential, t);
  scale(impact.u1, -s - t);
  scale(impact.v1, -s);
  for (Instant& event : impact.events) {
    scale(event.tau, w - s);
    scale(event.f, w - s + t);
    scale(event.u, -s - t);
    scale(event.v, -s);
  }
}

TEST(PlanarSymmetryTest, ScalingUnitsByPowersOfTwoChangesNoBit) {
  SceneSource source(9);
  for (int i = 0; i < kScenes; ++i) {
    const Problem problem = source.Any();
    const int w = static_cast<int>(source.Below(400)) - 200;
    const int s = static_cast<int>(source.Below(300)) - 150;
    const int t = static_cast<int>(source.Below(200)) - 100;
    const Impact expected = Solve(problem);
    Impact impact = Solve(Scaled(problem, w, s, t));
    ScaleBack(w, s, t, impact);
    ASSERT_EQ(impact.regime, expected.regime) << ToString(problem);
    ASSERT_EQ(NumbersOf(impact), NumbersOf(expected)) << ToString(problem) << " " << w << " " << s << " " << t;
  }
}

// ---- The pendulum ----

struct Pendulum {
  pendulum::Problem own;
  Problem planar;
};

Pendulum MakePendulum(double inertia, double a, double b, double omega, double mu, RestitutionLaw law,
                      double coefficient) {
  return {.own = {.inertia = inertia,
                  .a = a,
                  .b = b,
                  .omega_minus = omega,
                  .mu = mu,
                  .mu_static = mu,
                  .law = law,
                  .coefficient = coefficient},
          .planar = {.w = {b * b / inertia, a * b / inertia, a * a / inertia},
                     .u0 = b * omega,
                     .v0 = a * omega,
                     .mu = mu,
                     .mu_static = mu,
                     .law = law,
                     .coefficient = coefficient}};
}

struct Pair {
  const char* name;
  double own;
  double planar;
};

std::vector<Pair> PairsOf(const pendulum::Impact& own, const Impact& planar) {
  using pendulum::Output;
  return {{"newton", own[Output::kNewton], planar.newton},
          {"poisson", own[Output::kPoisson], planar.poisson},
          {"energetic", own[Output::kEnergetic], planar.energetic},
          {"u1", own[Output::kTangentialVelocityAfter], planar.u1},
          {"v1", own[Output::kNormalVelocityAfter], planar.v1},
          {"tau_c", own[Output::kNormalImpulseCompression], planar.tau_compression},
          {"tau1", own[Output::kNormalImpulse], planar.tau1},
          {"f_c", own[Output::kTangentialImpulseCompression], planar.f_compression},
          {"wc_n", own[Output::kWorkNormalCompression], planar.work_normal_compression},
          {"wr_n", own[Output::kWorkNormalRestitution], planar.work_normal_restitution},
          {"wc_t", own[Output::kWorkTangentialCompression], planar.work_tangential_compression},
          {"wr_t", own[Output::kWorkTangentialRestitution], planar.work_tangential_restitution}};
}

Regime PlanarName(Regime regime) { return regime == Regime::kRebound ? Regime::kReversalInRestitution : regime; }

TEST(PlanarPendulumTest, WhereWIsExactThePendulumsClosedFormIsReproducedToOneUlp) {
  SceneSource source(10);
  int locked = 0;
  for (int i = 0; i < kScenes; ++i) {
    const double inertia = std::exp2(static_cast<double>(source.Below(7)) - 3.0);
    const double a = 1.0 + static_cast<double>(source.Below(1000));
    const double b = static_cast<double>(source.Below(2001)) - 1000.0;
    const double omega = -1.0 - static_cast<double>(source.Below(1000));
    const double mu = i % 16 == 0 ? static_cast<double>(source.Below(9)) / 4.0 : source.Uniform(0.0, 2.0);
    const RestitutionLaw law = static_cast<RestitutionLaw>(source.Below(3));
    const Pendulum both = MakePendulum(inertia, a, b, omega, mu, law, source.UnitCoefficient());
    const pendulum::Impact own = pendulum::Solve(both.own);
    const Impact planar = Solve(both.planar);
    ASSERT_EQ(planar.w_rank, 1) << ToString(both.planar);
    ASSERT_EQ(planar.regime, PlanarName(own.regime)) << ToString(both.planar);
    ASSERT_EQ(planar.sharp_limit_broken, own.sharp_limit_broken) << ToString(both.planar);
    ASSERT_EQ(planar.energy_limit_broken, own.energy_limit_broken) << ToString(both.planar);
    for (const Pair& pair : PairsOf(own, planar)) {
      ASSERT_LE(UlpDistance(pair.own, pair.planar), 1U) << pair.name << " of " << ToString(both.planar);
    }
    locked += own.regime == Regime::kLocked;
  }
  EXPECT_GT(locked, kScenes / 10);
}

// The rounding of W, of some eps, is magnified by a - mu |b|.
TEST(PlanarPendulumTest, WhereWIsRoundedThePendulumIsReproducedWithinItsConditioning) {
  SceneSource source(11);
  for (int i = 0; i < kScenes; ++i) {
    const double a = source.Uniform(0.1, 10.0);
    const double b = source.Uniform(-10.0, 10.0);
    const double mu = source.Uniform(0.0, 1.5);
    const double slope_ratio = std::fabs(a - mu * std::fabs(b)) / (a + mu * std::fabs(b));
    if (slope_ratio < 1e-6) continue;
    const Pendulum both = MakePendulum(source.Uniform(0.1, 10.0), a, b, -source.Uniform(0.1, 10.0), mu,
                                       static_cast<RestitutionLaw>(source.Below(3)), source.UnitCoefficient());
    const pendulum::Impact own = pendulum::Solve(both.own);
    const Impact planar = Solve(both.planar);
    ASSERT_EQ(planar.w_rank, 1) << ToString(both.planar);
    ASSERT_EQ(planar.regime, PlanarName(own.regime)) << ToString(both.planar);
    for (const Pair& pair : PairsOf(own, planar)) {
      ASSERT_LE(std::fabs(pair.own - pair.planar), 0x1p-48 / slope_ratio * std::fabs(pair.own))
          << pair.name << " of " << ToString(both.planar);
    }
  }
}

// ---- Histories and targets ----

TEST(PlanarHistoryTest, EventsAreMetExactlyAndUIsZeroAllAlongStick) {
  SceneSource source(12);
  for (int i = 0; i < 10'000; ++i) {
    const Problem problem = source.Any();
    const Impact impact = Solve(problem);
    for (int k = 1; k < impact.event_count; ++k) {
      const Instant& from = impact.events[static_cast<size_t>(k - 1)];
      const Instant& to = impact.events[static_cast<size_t>(k)];
      if (to.tau > from.tau) {
        const Instant there = At(problem, impact, to.tau);
        ASSERT_EQ(there.u, to.u) << ToString(problem);
        ASSERT_EQ(there.v, to.v) << ToString(problem);
        ASSERT_EQ(there.f, to.f) << ToString(problem);
      }
      if (from.u == 0.0 && to.u == 0.0) {
        ASSERT_EQ(At(problem, impact, 0.5 * (from.tau + to.tau)).u, 0.0) << ToString(problem);
      }
    }
    ASSERT_EQ(At(problem, impact, 0.0).u, problem.u0) << ToString(problem);
    ASSERT_EQ(At(problem, impact, 0.0).v, problem.v0) << ToString(problem);
  }
}

TEST(PlanarTargetsTest, EveryTargetGivesTheSameBits) {
  std::vector<Problem> problems;
  SceneSource source(13);
  for (int i = 0; i < 20'000; ++i) problems.push_back(i % 8 == 0 ? source.OverAllDoubles() : source.Any());
  const auto bits = [&problems] {
    std::vector<uint64_t> all;
    for (const Problem& problem : problems) {
      for (const double number : NumbersOf(Solve(problem))) all.push_back(std::bit_cast<uint64_t>(number));
    }
    return all;
  };
  const std::vector<uint64_t> expected = bits();
  for (const int64_t target : hwy::SupportedAndGeneratedTargets()) {
    const OnlyTarget only(target);
    EXPECT_TRUE(bits() == expected) << hwy::TargetName(target);
  }
}

}  // namespace
}  // namespace ricochet::planar
