// The impact laws: cases worked by hand, cases that create energy, cases with no or several solutions, and random ones.

#include "core/models/laws/impact_law.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <sstream>
#include <string>
#include <vector>

namespace ricochet::laws {
namespace {

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();

void ExpectSolution(const ImpactSolution& got, const ImpactSolution& want, double tolerance = 4.0 * kEpsilon) {
  EXPECT_NEAR(got.f, want.f, tolerance);
  EXPECT_NEAR(got.tau1, want.tau1, tolerance);
  EXPECT_NEAR(got.u1, want.u1, tolerance);
  EXPECT_NEAR(got.v1, want.v1, tolerance);
  EXPECT_NEAR(got.energy_change, want.energy_change, tolerance);
}

void ExpectOnly(const ImpactLawResult& got, const ImpactSolution& want) {
  ASSERT_EQ(got.solutions.size(), 1u);
  ExpectSolution(got.solutions.front(), want);
}

// ---- By hand ----

// A rod of 1 kg and 1 m (J = 1/12) that strikes with its end at 45 degrees: r = (1, 1) sqrt(1/8) from the centre,
// W = [1 + 12/8, 12/8; 12/8, 1 + 12/8] up to the sign of t.
PlanarProblem SlantedRod(double mu) { return {.w = {2.5, 1.5, 2.5}, .u0 = -1.0, .v0 = -1.0, .mu = mu}; }

// sgn(u0) = -1: tau1 = 2/(2.5 + .7 1.5) = 2/3.55 = 40/71, f = .7 40/71 = 28/71,
// u1 = -1 + 2.5 28/71 + 1.5 40/71 = 59/71, dE = (f (u0 + u1) + 0)/2 = 14/71 (-12/71) = -168/5041.
TEST(WhittakerTest, SlantedRodByHand) {
  ExpectOnly(SolveWhittaker(SlantedRod(0.7), 1.0),
             {.f = 28.0 / 71, .tau1 = 40.0 / 71, .u1 = 59.0 / 71, .v1 = 1.0, .energy_change = -168.0 / 5041});
}

// mu = 2 instead gives tau1 = 2/5.5 = 4/11, f = 8/11, u1 = -1 + 20/11 + 6/11 = 15/11, dE = 4/11 4/11 = 16/121.
TEST(WhittakerTest, CreatesEnergyWhereSlipReverses) {
  ExpectOnly(SolveWhittaker(SlantedRod(2.0), 1.0),
             {.f = 8.0 / 11, .tau1 = 4.0 / 11, .u1 = 15.0 / 11, .v1 = 1.0, .energy_change = 16.0 / 121});
}

// c = 2, G = -2.5 + 3 = 1/2, T = 5 - 1.5 = 7/2, det = 4; |G| <= .7 T: f = -1/8, tau1 = 7/8, dE = -1/8 (-1)/2 = 1/16.
TEST(KaneLevinsonTest, SlantedRodSticksByHandAndGainsEnergy) {
  ExpectOnly(SolveKaneLevinson(SlantedRod(0.7), 1.0),
             {.f = -1.0 / 8, .tau1 = 7.0 / 8, .u1 = 0.0, .v1 = 1.0, .energy_change = 1.0 / 16});
}

// Wtn - mu Wtt is 1.46e-16 Wtn > 0 (exact rational arithmetic), where the rounded product mu Wtt equals Wtn.
TEST(KaneLevinsonTest, SlipsWhereFrictionFallsShortByLessThanRounding) {
  const ImpactLawResult got = SolveKaneLevinson({.w = {0.987765508032018, 1.6065211492554237, 2.6128774309476523},
                                                 .u0 = 0.0,
                                                 .v0 = -0.3226154719687275,
                                                 .mu = 1.6264195663768295},
                                                1.0);
  ASSERT_EQ(got.solutions.size(), 1u);
  EXPECT_NEAR(got.solutions[0].u1, 3.430536e-4, 1e-10);
  EXPECT_NEAR(got.solutions[0].tau1, 1.465055575e12, 1e3);
  EXPECT_NEAR(got.solutions[0].f, -2.382795054e12, 1e3);
}

// mu = .1: G = .5 > .1 T = .35, slip towards +t: tau1 = 2/(2.5 - .15) = 40/47, f = -4/47,
// u1 = -1 + (1.5 - .25) 40/47 = 3/47, dE = (-4/47)(-44/47)/2 = 88/2209.
TEST(KaneLevinsonTest, SlantedRodSlipsByHand) {
  ExpectOnly(SolveKaneLevinson(SlantedRod(0.1), 1.0),
             {.f = -4.0 / 47, .tau1 = 40.0 / 47, .u1 = 3.0 / 47, .v1 = 1.0, .energy_change = 88.0 / 2209});
}

// mu_hat = 1/5: tau1 = 2/(2.5 + .3) = 5/7, f = 1/7, u1 = -1 + 2.5/7 + 7.5/7 = 3/7, dE = (1/7)(-4/7)/2 = -2/49.
TEST(BrachTest, SlantedRodByHand) {
  ExpectOnly(SolveBrach(SlantedRod(0.7), 1.0, 0.2),
             {.f = 1.0 / 7, .tau1 = 5.0 / 7, .u1 = 3.0 / 7, .v1 = 1.0, .energy_change = -2.0 / 49});
}

// P_I = (0, 2/5), P_II = -W^-1 (-1, -1) = (1/4, 1/4); P = 3/2 P_I + 3/2 (1/4, -3/20) = (3/8, 3/8), in the cone of 1.2:
// u1 = -1 + 4 3/8 = 1/2 = v1, dE = 3/8 (-1/2)/2 + 3/8 (-1/2)/2 = -3/16.
TEST(ChatterjeeRuinaTest, SlantedRodInsideTheConeByHand) {
  ExpectOnly(SolveChatterjeeRuina(SlantedRod(1.2), 0.5, 0.5),
             {.f = 3.0 / 8, .tau1 = 3.0 / 8, .u1 = 0.5, .v1 = 0.5, .energy_change = -3.0 / 16});
}

// mu = .7: P above is outside. kappa = .7 3/2 2/5/(1/4 + .7 3/20) = .42/.355 = 84/71, P = (0, 3/5) + 84/71 (1/4, -3/20)
// = (21/71, 30/71), u1 = -1 + 52.5/71 + 45/71 = 53/142, dE = (21/71 (-89/142) + 30/71 (-1/2))/2 = -3999/20164.
TEST(ChatterjeeRuinaTest, SlantedRodOnTheConeByHand) {
  ExpectOnly(SolveChatterjeeRuina(SlantedRod(0.7), 0.5, 0.5),
             {.f = 21.0 / 71, .tau1 = 30.0 / 71, .u1 = 53.0 / 142, .v1 = 0.5, .energy_change = -3999.0 / 20164});
}

// W = [1, 1; 1, 1 + d], d = 2^-40, v = (-1, -1): det = d, G = e - d, T = e. A rounded c would leave G ten digits.
// With e_t = e the slip turns round times e, whatever W couples.
TEST(ChatterjeeRuinaTest, EqualCoefficientsTurnTheSlipHoweverStrongTheCoupling) {
  for (const double coupling : {1e2, 1e4, 1e6}) {
    PlanarProblem in;
    in.w = {.tt = 2.0 * coupling * coupling, .tn = coupling, .nn = 1.0};
    in.u0 = 0.1;
    in.v0 = -0.3;
    in.mu = in.mu_static = 1000.0;
    EXPECT_NEAR(SolveChatterjeeRuina(in, 1.0, 1.0).solutions.at(0).u1, -0.1, 1e-16) << coupling;
  }
}

TEST(KaneLevinsonTest, StickingImpulseIsExactNearRankOne) {
  const double d = 0x1p-40;
  const double e = 1e-6;
  const PlanarProblem input = {.w = {1.0, 1.0, 1.0 + d}, .u0 = -1.0, .v0 = -1.0, .mu = 1.0};
  const ImpactLawResult result = SolveKaneLevinson(input, e);
  ASSERT_EQ(result.solutions.size(), 1u);
  EXPECT_DOUBLE_EQ(result.solutions.front().f, -(e - d) / d);
  EXPECT_DOUBLE_EQ(result.solutions.front().tau1, e / d);
}

// ---- Kane's paradox ----

// Two rods of 1 m and 1 kg, 20 and 30 degrees from the downward vertical, at -0.1 and -0.2 rad/s; the tip strikes.
struct DoublePendulum {
  static constexpr double kDegree = std::numbers::pi / 180.0;
  std::array<double, 2> along = {std::cos(20.0 * kDegree), std::cos(30.0 * kDegree)};
  std::array<double, 2> normal = {std::sin(20.0 * kDegree), std::sin(30.0 * kDegree)};
  std::array<double, 2> rates = {-0.1, -0.2};
  // The mass matrix: m l^2 (1/3 + 1), m l^2/2 cos(10 degrees), m l^2/3.
  double m11 = 4.0 / 3;
  double m12 = 0.5 * std::cos(10.0 * kDegree);
  double m22 = 1.0 / 3;

  // M^-1 row.
  std::array<double, 2> Response(const std::array<double, 2>& row) const {
    const double det = m11 * m22 - m12 * m12;
    return {(m22 * row[0] - m12 * row[1]) / det, (m11 * row[1] - m12 * row[0]) / det};
  }
  static double Dot(const std::array<double, 2>& a, const std::array<double, 2>& b) {
    return a[0] * b[0] + a[1] * b[1];
  }
  PlanarProblem Input(double mu) const {
    return {.w = {Dot(along, Response(along)), Dot(along, Response(normal)), Dot(normal, Response(normal))},
            .u0 = Dot(along, rates),
            .v0 = Dot(normal, rates),
            .mu = mu};
  }
  double Energy(const std::array<double, 2>& w) const {
    return 0.5 * (m11 * w[0] * w[0] + m22 * w[1] * w[1]) + m12 * w[0] * w[1];
  }
  // E+/E- - 1 through the joint rates, without W.
  double RelativeGain(const ImpactSolution& solution) const {
    const std::array<double, 2> from_f = Response(along);
    const std::array<double, 2> from_tau = Response(normal);
    std::array<double, 2> after = rates;
    for (size_t i = 0; i < 2; ++i) after[i] += from_f[i] * solution.f + from_tau[i] * solution.tau1;
    return Energy(after) / Energy(rates) - 1.0;
  }
};

void ExpectGain(const ImpactLawResult& result, double gain, double tolerance) {
  const DoublePendulum pendulum;
  ASSERT_EQ(result.solutions.size(), 1u);
  const ImpactSolution& solution = result.solutions.front();
  EXPECT_NEAR(pendulum.RelativeGain(solution), gain, tolerance);
  EXPECT_NEAR(solution.energy_change / pendulum.Energy(pendulum.rates), pendulum.RelativeGain(solution), 1e-13);
}

TEST(KaneParadoxTest, KaneLevinsonMultipliesTheDoublePendulumsEnergy) {
  const PlanarProblem input = DoublePendulum().Input(0.7);
  ExpectGain(SolveKaneLevinson(input, 1.0), 5.35, 0.005);
  ExpectGain(SolveKaneLevinson(input, 0.7), 2.11, 0.005);
  ExpectGain(SolveKaneLevinson(input, 0.5), 0.587, 0.0005);
}

TEST(KaneParadoxTest, KaneLevinsonSticksWhereTheTipReboundsFully) {
  const ImpactLawResult result = SolveKaneLevinson(DoublePendulum().Input(0.7), 1.0);
  ASSERT_EQ(result.solutions.size(), 1u);
  EXPECT_EQ(result.solutions.front().u1, 0.0);
}

TEST(KaneParadoxTest, WhittakersOneDirectionLosesEnergyThere) {
  ExpectGain(SolveWhittaker(DoublePendulum().Input(0.7), 1.0), -0.2276, 0.00005);
}

// The linkage has less slip before the impact here: friction in one direction drives the reversed slip.
TEST(KaneParadoxTest, WhittakerGainsEnergyOnceTheFirstRodSwingsBack) {
  PlanarProblem input = DoublePendulum().Input(0.7);
  input.u0 = -0.05;
  const ImpactLawResult result = SolveWhittaker(input, 1.0);
  ASSERT_EQ(result.solutions.size(), 1u);
  EXPECT_GT(result.solutions.front().u1, 0.05);
  EXPECT_GT(result.solutions.front().energy_change, 0.0);
}

TEST(KaneParadoxTest, ChatterjeeRuinaLosesEnergyThere) {
  for (const double e_t : {-1.0, 0.0, 0.5, 1.0}) {
    const ImpactLawResult result = SolveChatterjeeRuina(DoublePendulum().Input(0.7), 1.0, e_t);
    ASSERT_EQ(result.solutions.size(), 1u);
    EXPECT_LE(result.solutions.front().energy_change, 1e-16) << e_t;
  }
}

// ---- Degenerate contacts ----

std::vector<ImpactLawResult> AllLaws(const PlanarProblem& input, double e) {
  return {SolveWhittaker(input, e), SolveKaneLevinson(input, e), SolveBrach(input, e, input.mu),
          SolveChatterjeeRuina(input, e, 0.5)};
}

TEST(ImpactLawsTest, SeparatingContactIsLeftAlone) {
  for (const double v0 : {0.0, 2.0}) {
    PlanarProblem input = SlantedRod(0.7);
    input.v0 = v0;
    for (const ImpactLawResult& result : AllLaws(input, 0.5)) ExpectOnly(result, {.u1 = -1.0, .v1 = v0});
  }
}

TEST(ImpactLawsTest, ContactThatCannotMoveAlongTheNormalHasNoSolution) {
  for (const ImpactLawResult& result : AllLaws({.w = {.tt = 1.0}, .u0 = 1.0, .v0 = -1.0, .mu = 0.5}, 0.5)) {
    EXPECT_TRUE(result.solutions.empty());
  }
}

// wnn - mu wtn = 2.5 - 3 for slip towards +t.
TEST(ImpactLawsTest, SelfLockingHasNoWhittakerAndNoBrachSolution) {
  PlanarProblem input = SlantedRod(2.0);
  input.u0 = 1.0;
  EXPECT_TRUE(SolveWhittaker(input, 0.5).solutions.empty());
  EXPECT_TRUE(SolveBrach(input, 0.5, -2.0).solutions.empty());
  EXPECT_EQ(SolveKaneLevinson(input, 0.5).solutions.size(), 1u);
  EXPECT_EQ(SolveChatterjeeRuina(input, 0.5, 0.5).solutions.size(), 1u);
}

TEST(WhittakerTest, WithoutInitialSlipThereIsNoFriction) {
  PlanarProblem input = SlantedRod(0.7);
  input.u0 = 0.0;
  ExpectOnly(SolveWhittaker(input, 1.0), {.f = 0.0, .tau1 = 0.8, .u1 = 1.2, .v1 = 1.0, .energy_change = 0.0});
}

// The pendulum a = 4, b = 1, J0 = 1, w- = -1: rank one, x = mu/4, and every law has u1 = -e u0.
PlanarProblem Pendulum(double mu) { return {.w = {1.0, 4.0, 16.0}, .u0 = -1.0, .v0 = -4.0, .mu = mu}; }

TEST(ImpactLawsTest, RankOneVelocitiesDoNotDependOnFriction) {
  for (const ImpactLawResult& result : AllLaws(Pendulum(0.5), 0.5)) {
    ASSERT_EQ(result.solutions.size(), 1u);
    EXPECT_EQ(result.solutions.front().u1, 0.5);
    EXPECT_EQ(result.solutions.front().v1, 2.0);
    EXPECT_NEAR(result.solutions.front().energy_change, (0.25 - 1.0) / 2.0, 4.0 * kEpsilon);
  }
}

// s = +1: tau1 = 6/(16 - 2) = 3/7, f = -3/14. At mu = 4 the pendulum is locked: x = 1.
TEST(KaneLevinsonTest, PendulumReboundsUntilFrictionLocksIt) {
  ExpectOnly(SolveKaneLevinson(Pendulum(0.5), 0.5),
             {.f = -3.0 / 14, .tau1 = 3.0 / 7, .u1 = 0.5, .v1 = 2.0, .energy_change = -3.0 / 8});
  EXPECT_TRUE(SolveKaneLevinson(Pendulum(4.0), 0.5).solutions.empty());
  EXPECT_TRUE(SolveKaneLevinson(Pendulum(5.0), 0.5).solutions.empty());
}

// f = -tau1/2: tau1 = 4/14 = 2/7. f = tau1/2: tau1 = 4/18 = 2/9. Both stop the pendulum: dE = -1/2.
// The slip is -1, so that f > 0 opposes it.
TEST(KaneLevinsonTest, PlasticPendulumHasARangeOfImpulsesAndTakesTheOneThatOpposesSlip) {
  const ImpactLawResult result = SolveKaneLevinson(Pendulum(0.5), 0.0);
  ExpectOnly(result, {.f = 1.0 / 9, .tau1 = 2.0 / 9, .energy_change = -0.5});
  ASSERT_EQ(result.ends.size(), 2u);
  ExpectSolution(result.ends[0], {.f = -1.0 / 7, .tau1 = 2.0 / 7, .energy_change = -0.5});
  ExpectSolution(result.ends[1], {.f = 1.0 / 9, .tau1 = 2.0 / 9, .energy_change = -0.5});
  // One side of the cone locks (16 - 4 4 = 0), so that the range has no end there: tau1 = 4/32 at the other.
  const ImpactLawResult endless = SolveKaneLevinson(Pendulum(4.0), 0.0);
  ExpectOnly(endless, {.f = 0.5, .tau1 = 0.125, .energy_change = -0.5});
  EXPECT_EQ(endless.ends.size(), 1u);
}

// The pendulum's surface moves: u0 = -3, v0 = -4, H = -48 + 16 = -32. v1 = 2, u1 = -3 + (4/16) 6 = -3/2 whatever
// friction is.
TEST(ImpactLawsTest, AVelocityBesideTheRangeKeepsItsPartThatNoImpulseMoves) {
  PlanarProblem input = Pendulum(0.5);
  input.u0 = -3.0;
  for (const ImpactLawResult& result : AllLaws(input, 0.5)) {
    ASSERT_EQ(result.solutions.size(), 1u);
    EXPECT_EQ(result.solutions.front().u1, -1.5);
    EXPECT_EQ(result.solutions.front().v1, 2.0);
    EXPECT_TRUE(result.ends.empty());
  }
  // Slip ends as -3/2 < 0: f = tau1/2, tau1 = 6/18.
  EXPECT_NEAR(SolveKaneLevinson(input, 0.5).solutions.front().f, 1.0 / 6, 4.0 * kEpsilon);
  EXPECT_NEAR(SolveWhittaker(input, 0.5).solutions.front().f, 1.0 / 6, 4.0 * kEpsilon);
  // No impulse ends approach and slip together: as det W vanishes, P_II - P_I grows without limit against the slip.
  EXPECT_NEAR(SolveChatterjeeRuina(input, 0.5, 0.5).solutions.front().f, 1.0 / 6, 4.0 * kEpsilon);
  EXPECT_EQ(SolveChatterjeeRuina(input, 0.5, -1.0).solutions.front().f, 0.0);
}

// P_II = 4/17 (1/4, 1), P_II - P_I = (1/17, -1/68): P = (3/34, 3/8 - 3/136) = (3/34, 6/17).
TEST(ChatterjeeRuinaTest, PendulumTakesTheStickingImpulseOfLeastNorm) {
  ExpectOnly(SolveChatterjeeRuina(Pendulum(0.5), 0.5, 0.5),
             {.f = 3.0 / 34, .tau1 = 6.0 / 17, .u1 = 0.5, .v1 = 2.0, .energy_change = -3.0 / 8});
}

// ---- At random ----

constexpr int kCases = 100'000;

class Cases {
 public:
  // Every eighth W is within 1e-12 ... 1e-2 of rank one.
  PlanarProblem Next() {
    const double wtt = std::pow(10.0, Between(-1.0, 1.0));
    const double wnn = std::pow(10.0, Between(-1.0, 1.0));
    double rho = Between(-1.0, 1.0);
    if (++count_ % 8 == 0) rho = std::copysign(1.0 - std::pow(10.0, Between(-12.0, -2.0)), rho);
    return {.w = {wtt, rho * std::sqrt(wtt * wnn), wnn},
            .u0 = Between(-3.0, 3.0),
            .v0 = -Between(0.01, 3.0),
            .mu = Between(0.0, 2.0)};
  }
  double Between(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random_); }

 private:
  std::mt19937_64 random_{20240229};
  int64_t count_ = 0;
};

std::string Print(const PlanarProblem& in) {
  std::ostringstream text;
  text.precision(17);
  text << "W = " << in.w.tt << " " << in.w.tn << " " << in.w.nn << ", v = " << in.u0 << " " << in.v0
       << ", mu = " << in.mu;
  return text.str();
}

// Momentum balance and energy, in more digits. `scale` bounds the terms of the sums; two impulses of some 4 ulp each.
void ExpectConsistent(const PlanarProblem& in, double e, const ImpactSolution& s) {
  const long double f = s.f;
  const long double tau = s.tau1;
  const long double du = in.w.tt * f + in.w.tn * tau;
  const long double dv = in.w.tn * f + in.w.nn * tau;
  const double impulse = std::max(std::abs(s.f), s.tau1);
  const double scale = std::abs(in.u0) + std::abs(in.v0) + std::max(in.w.tt, in.w.nn) * impulse;
  EXPECT_NEAR(s.v1, -e * in.v0, kEpsilon * std::abs(in.v0)) << Print(in);
  EXPECT_NEAR(static_cast<double>(in.v0 + dv), s.v1, 8.0 * kEpsilon * scale) << Print(in);
  EXPECT_NEAR(static_cast<double>(in.u0 + du), s.u1, 8.0 * kEpsilon * scale) << Print(in);
  EXPECT_NEAR(static_cast<double>(f * (in.u0 + 0.5L * du) + tau * (in.v0 + 0.5L * dv)), s.energy_change,
              16.0 * kEpsilon * scale * impulse)
      << Print(in);
  EXPECT_GT(s.tau1, 0.0) << Print(in);
}

void ExpectInCone(const PlanarProblem& in, const ImpactSolution& s) {
  EXPECT_LE(std::abs(s.f), in.mu * s.tau1 * (1.0 + 8.0 * kEpsilon)) << Print(in);
}

TEST(ImpactLawsTest, WhittakerHoldsAtRandom) {
  Cases cases;
  int locked = 0;
  for (int i = 0; i < kCases && !HasFailure(); ++i) {
    const PlanarProblem in = cases.Next();
    const double e = cases.Between(0.0, 1.0);
    const ImpactLawResult result = SolveWhittaker(in, e);
    const double slope = std::fma(-std::copysign(in.mu, in.u0), in.w.tn, in.w.nn);
    ASSERT_EQ(result.solutions.size(), slope > 0.0 ? 1u : 0u) << Print(in);
    locked += result.solutions.empty() ? 1 : 0;
    for (const ImpactSolution& s : result.solutions) {
      ExpectConsistent(in, e, s);
      EXPECT_EQ(s.f, -std::copysign(in.mu, in.u0) * s.tau1) << Print(in);
    }
  }
  EXPECT_GT(locked, kCases / 20);
}

TEST(ImpactLawsTest, BrachHoldsAtRandom) {
  Cases cases;
  for (int i = 0; i < kCases && !HasFailure(); ++i) {
    const PlanarProblem in = cases.Next();
    const double e = cases.Between(0.0, 1.0);
    const double mu_hat = cases.Between(-1.0, 1.0);
    for (const ImpactSolution& s : SolveBrach(in, e, mu_hat).solutions) {
      ExpectConsistent(in, e, s);
      EXPECT_EQ(s.f, mu_hat * s.tau1) << Print(in);
    }
  }
}

TEST(ImpactLawsTest, KaneLevinsonHasExactlyOneCoulombSolutionAtRandom) {
  Cases cases;
  int stuck = 0;
  int gained = 0;
  for (int i = 0; i < kCases && !HasFailure(); ++i) {
    const PlanarProblem in = cases.Next();
    const double e = cases.Between(0.0, 1.0);
    const ImpactLawResult result = SolveKaneLevinson(in, e);
    ASSERT_EQ(result.solutions.size(), 1u) << Print(in);
    const ImpactSolution& s = result.solutions.front();
    ExpectConsistent(in, e, s);
    ExpectInCone(in, s);
    if (s.u1 != 0.0) {
      EXPECT_EQ(s.f, -std::copysign(in.mu, s.u1) * s.tau1) << Print(in);
    }
    stuck += s.u1 == 0.0 ? 1 : 0;
    gained += s.energy_change > 1e-9 ? 1 : 0;
  }
  EXPECT_GT(stuck, kCases / 10);
  EXPECT_GT(kCases - stuck, kCases / 10);
  EXPECT_GT(gained, kCases / 100);
}

struct VectorFormImpulse {
  long double f = 0.0L;
  long double tau1 = 0.0L;
  bool on_cone = false;
};

// The law in its vector form, from P_I, P_II and kappa, in more digits.
VectorFormImpulse ChatterjeeRuinaInVectorForm(const PlanarProblem& in, double e, double e_t) {
  const long double det = static_cast<long double>(in.w.tt) * in.w.nn - static_cast<long double>(in.w.tn) * in.w.tn;
  const long double first_n = -static_cast<long double>(in.v0) / in.w.nn;
  const long double second_t =
      -(static_cast<long double>(in.w.nn) * in.u0 - static_cast<long double>(in.w.tn) * in.v0) / det;
  const long double second_n =
      -(static_cast<long double>(in.w.tt) * in.v0 - static_cast<long double>(in.w.tn) * in.u0) / det;
  const auto weighted = [&](long double k) {
    return VectorFormImpulse{.f = k * second_t, .tau1 = (1.0L + e) * first_n + k * (second_n - first_n)};
  };
  const VectorFormImpulse candidate = weighted(1.0L + e_t);
  if (std::abs(candidate.f) <= in.mu * candidate.tau1) return candidate;
  VectorFormImpulse result =
      weighted(in.mu * (1.0L + e) * first_n / (std::abs(second_t) - in.mu * (second_n - first_n)));
  result.on_cone = true;
  return result;
}

TEST(ImpactLawsTest, ChatterjeeRuinaAgreesWithItsVectorFormAndNeverCreatesEnergyAtRandom) {
  Cases cases;
  int on_cone = 0;
  for (int i = 0; i < kCases && !HasFailure(); ++i) {
    const PlanarProblem in = cases.Next();
    const double e = cases.Between(0.0, 1.0);
    const double e_t = cases.Between(-1.0, 1.0);
    const ImpactLawResult result = SolveChatterjeeRuina(in, e, e_t);
    ASSERT_EQ(result.solutions.size(), 1u) << Print(in);
    const ImpactSolution& s = result.solutions.front();
    ExpectConsistent(in, e, s);
    ExpectInCone(in, s);
    const VectorFormImpulse reference = ChatterjeeRuinaInVectorForm(in, e, e_t);
    const double impulse = std::max(std::abs(s.f) * std::max(1.0, std::abs(in.w.tn) / in.w.nn), s.tau1);
    const long double conditioning = in.w.tt * in.w.nn / std::fma(in.w.tt, in.w.nn, -in.w.tn * in.w.tn);
    const double reference_error =
        static_cast<double>(64.0L * std::numeric_limits<long double>::epsilon() * conditioning);
    EXPECT_NEAR(static_cast<double>(reference.f), s.f, (16.0 * kEpsilon + reference_error) * impulse) << Print(in);
    EXPECT_NEAR(static_cast<double>(reference.tau1), s.tau1, (16.0 * kEpsilon + reference_error) * impulse)
        << Print(in);
    EXPECT_LE(s.energy_change, 8.0 * kEpsilon * impulse * (std::abs(in.u0) + std::abs(in.v0) + std::abs(s.u1)))
        << Print(in);
    on_cone += reference.on_cone ? 1 : 0;
  }
  EXPECT_GT(on_cone, kCases / 10);
  EXPECT_GT(kCases - on_cone, kCases / 10);
}

TEST(ImpactLawsTest, WithoutFrictionAllLawsAgreeAtRandom) {
  Cases cases;
  for (int i = 0; i < kCases && !HasFailure(); ++i) {
    PlanarProblem in = cases.Next();
    in.mu = 0.0;
    const double e = cases.Between(0.0, 1.0);
    const double tau1 = std::fma(-e, in.v0, -in.v0) / in.w.nn;
    for (const ImpactLawResult& result : AllLaws(in, e)) {
      ASSERT_EQ(result.solutions.size(), 1u) << Print(in);
      const ImpactSolution& s = result.solutions.front();
      EXPECT_EQ(s.f, 0.0) << Print(in);
      EXPECT_EQ(s.tau1, tau1) << Print(in);
      EXPECT_EQ(s.u1, std::fma(tau1, in.w.tn, in.u0)) << Print(in);
    }
  }
}

void ExpectMirrored(const ImpactLawResult& one, const ImpactLawResult& other, const std::string& where) {
  ASSERT_EQ(one.solutions.size(), other.solutions.size()) << where;
  for (size_t i = 0; i < one.solutions.size(); ++i) {
    EXPECT_EQ(one.solutions[i].f, -other.solutions[i].f) << where;
    EXPECT_EQ(one.solutions[i].tau1, other.solutions[i].tau1) << where;
    EXPECT_EQ(one.solutions[i].u1, -other.solutions[i].u1) << where;
    EXPECT_EQ(one.solutions[i].v1, other.solutions[i].v1) << where;
    EXPECT_EQ(one.solutions[i].energy_change, other.solutions[i].energy_change) << where;
  }
}

TEST(ImpactLawsTest, MirroredContactHasTheMirroredAnswerBitForBit) {
  Cases cases;
  for (int i = 0; i < kCases && !HasFailure(); ++i) {
    const PlanarProblem in = cases.Next();
    PlanarProblem mirrored = in;
    mirrored.w.tn = -in.w.tn;
    mirrored.u0 = -in.u0;
    const double e = cases.Between(0.0, 1.0);
    const double e_t = cases.Between(-1.0, 1.0);
    const double mu_hat = cases.Between(-1.0, 1.0);
    const std::string where = Print(in);
    ExpectMirrored(SolveWhittaker(in, e), SolveWhittaker(mirrored, e), where);
    ExpectMirrored(SolveKaneLevinson(in, e), SolveKaneLevinson(mirrored, e), where);
    ExpectMirrored(SolveBrach(in, e, mu_hat), SolveBrach(mirrored, e, -mu_hat), where);
    ExpectMirrored(SolveChatterjeeRuina(in, e, e_t), SolveChatterjeeRuina(mirrored, e, e_t), where);
  }
}

}  // namespace
}  // namespace ricochet::laws
