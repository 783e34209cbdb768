// Lubarda (2009): the worked numbers, the identities, the regimes and the limits of the rigid pendulum.

#include "core/models/pendulum/pendulum.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <vector>

#include "core/models/restitution_law.h"
#include "tests/support/oracles/pendulum_oracle.h"
#include "tests/support/oracles/ulp.h"
#include "tests/support/scenes/pendulum_scenes.h"

namespace ricochet::pendulum {
namespace {

constexpr int kScenes = 2'000;

Problem Make(double a, double b, double mu, RestitutionLaw law, double coefficient) {
  return {.inertia = 2.0,
          .a = a,
          .b = b,
          .omega_minus = -3.0,
          .mu = mu,
          .mu_static = mu,
          .law = law,
          .coefficient = coefficient};
}

// These sizes neither underflow nor overflow, so that identities hold to rounding.
std::vector<Impact> EverydayImpacts() {
  SceneSource source(24);
  std::vector<Impact> impacts;
  while (impacts.size() < kScenes) {
    const Impact impact = Solve(source.Everyday());
    if (impact.regime == Regime::kRebound && impact[Output::kNewton] > 1e-50) impacts.push_back(impact);
  }
  return impacts;
}

void ExpectRelativelyNear(double left, double right, double scale, double ulps) {
  EXPECT_LE(std::fabs(left - right), ulps * 0x1p-52 * std::fabs(scale)) << left << " vs " << right;
}

// ---- The paper's numbers ----

// After (25), (55): mu = 0.1, a/b = 0.3, so x = 1/3 and r = 1/2.
TEST(PendulumPaperTest, PoissonIsRootTwoTimesEtaAtXOneThird) {
  for (const double eta : {0.25, 0.5, 1.0}) {
    const Impact impact = Solve(Make(0.3, 1.0, 0.1, RestitutionLaw::kEnergetic, eta));
    EXPECT_NEAR(impact[Output::kPoisson], std::sqrt(2.0) * eta, 1e-15);
    EXPECT_NEAR(impact[Output::kNewton], eta / std::sqrt(2.0), 1e-15);
  }
}

// Section 8.1: "mu_hat = -0.017", the restitution phase lasts sqrt(2) times the compression phase.
TEST(PendulumPaperTest, ElasticImpactAtXOneThirdHasTangentialCoefficientMinusZeroPointZeroOneSeven) {
  const Impact impact = Solve(Make(0.3, 1.0, 0.1, RestitutionLaw::kEnergetic, 1.0));
  const double tau0 = impact[Output::kNormalImpulseCompression];
  EXPECT_NEAR(impact[Output::kTangentialCoefficient], -0.0172, 5e-5);
  EXPECT_NEAR(impact[Output::kTangentialCoefficient], -0.3 * (1.0 - std::sqrt(8.0) / 3.0), 1e-16);
  EXPECT_NEAR((impact[Output::kNormalImpulse] - tau0) / tau0, std::sqrt(2.0), 1e-15);
}

// Section 9: for mu = 0.4 and a = 4b first order gives 1.1, 0.9 and -0.02; the exact values lie within x^2 = 1 %.
TEST(PendulumPaperTest, NearlyVerticalExampleIsWithinOnePercentOfFirstOrder) {
  const Impact impact = Solve(Make(4.0, 1.0, 0.4, RestitutionLaw::kEnergetic, 1.0));
  EXPECT_NEAR(impact[Output::kPoisson], 1.1, 0.01);
  EXPECT_NEAR(impact[Output::kNewton], 0.9, 0.01);
  EXPECT_NEAR(impact[Output::kTangentialCoefficient], -0.02, 0.0002);
}

// Fig. 4: Newton's coefficient of an elastic impact over phi = arctan(a/b).
TEST(PendulumPaperTest, Figure4NewtonRisesFromZeroWherePhiIsTheAngleOfFrictionToOneAtTheVertical) {
  for (const double mu : {0.1, 1.0 / 3.0, 0.5, 2.0 / 3.0, 1.0}) {
    double previous = 0.0;
    for (int i = 1; i <= 100; ++i) {
      const double phi = i * (std::acos(0.0) / 100.0);
      const double a = std::sin(phi);
      const double b = std::cos(phi);
      const Impact impact = Solve(Make(a, b, mu, RestitutionLaw::kEnergetic, 1.0));
      const double tangent = a / std::fabs(b);  // The double for pi/2 may lie beyond the vertical.
      const double squared = tangent <= mu ? 0.0 : (tangent - mu) / (tangent + mu);
      EXPECT_NEAR(std::pow(impact[Output::kNewton], 2), squared, 1e-14) << "phi " << phi << " mu " << mu;
      EXPECT_GE(impact[Output::kNewton], previous);
      previous = impact[Output::kNewton];
    }
    EXPECT_NEAR(previous, 1.0, 1e-15);
  }
}

// (46), without the misprint in the middle of its right-hand side: W = -J mu b/(a + mu b) omega-^2.
TEST(PendulumPaperTest, FrictionTakesAllTheEnergyThatAnElasticImpactLoses) {
  const Impact impact = Solve(Make(0.3, 1.0, 0.1, RestitutionLaw::kEnergetic, 1.0));
  EXPECT_EQ(impact[Output::kWorkNormal], 0.0);
  EXPECT_NEAR(impact[Output::kWorkTangential], -2.0 * 0.1 / 0.4 * 9.0, 1e-14);
  EXPECT_NEAR(impact[Output::kEnergyChange], impact[Output::kWorkTangential], 1e-14);
}

// ---- Identities ----

TEST(PendulumIdentityTest, WorksAddUpToTheChangeOfEnergy) {
  for (const Impact& impact : EverydayImpacts()) {
    const double works = impact[Output::kWorkNormalCompression] + impact[Output::kWorkNormalRestitution] +
                         impact[Output::kWorkTangentialCompression] + impact[Output::kWorkTangentialRestitution];
    const double scale =
        std::max(std::fabs(impact[Output::kWorkNormalCompression] + impact[Output::kWorkTangentialCompression]),
                 impact[Output::kWorkNormalRestitution]);
    ExpectRelativelyNear(works, impact[Output::kEnergyChange], scale, 4.0);
    ExpectRelativelyNear(impact[Output::kWorkNormal] + impact[Output::kWorkTangential], impact[Output::kEnergyChange],
                         scale, 4.0);
  }
}

// (52): dE = -f1 (u- + u+)/2 - tau1 (v- + v+)/2.
TEST(PendulumIdentityTest, ThomsonTaitGivesTheEnergyFromImpulsesAndVelocities) {
  SceneSource source(52);
  for (int i = 0; i < kScenes; ++i) {
    const Problem problem = source.Everyday();
    const Impact impact = Solve(problem);
    const double u = problem.b * problem.omega_minus + impact[Output::kTangentialVelocityAfter];
    const double v = problem.a * problem.omega_minus + impact[Output::kNormalVelocityAfter];
    const double tangential = 0.5 * impact[Output::kTangentialImpulse] * u;
    const double normal = 0.5 * impact[Output::kNormalImpulse] * v;
    const double scale = std::fabs(0.5 * impact[Output::kTangentialImpulse] * problem.b * problem.omega_minus) +
                         std::fabs(0.5 * impact[Output::kNormalImpulse] * problem.a * problem.omega_minus) +
                         std::fabs(impact[Output::kEnergyChange]);
    ExpectRelativelyNear(tangential + normal, impact[Output::kEnergyChange], scale, 8.0);
  }
}

// (24)
TEST(PendulumIdentityTest, EtaIsTheGeometricMeanOfNewtonAndPoisson) {
  for (const Impact& impact : EverydayImpacts()) {
    const double eta = impact[Output::kEnergetic];
    ExpectRelativelyNear(impact[Output::kNewton] * impact[Output::kPoisson], eta * eta, eta * eta, 4.0);
    EXPECT_LE(impact[Output::kNewton], eta);
    EXPECT_GE(impact[Output::kPoisson], eta);
  }
}

// (40)
TEST(PendulumIdentityTest, RestitutionReturnsEtaSquaredOfTheWorkOfCompressionInBothDirections) {
  for (const Impact& impact : EverydayImpacts()) {
    const double eta_squared = impact[Output::kEnergetic] * impact[Output::kEnergetic];
    const double normal = -impact[Output::kWorkNormalRestitution] / impact[Output::kWorkNormalCompression];
    ExpectRelativelyNear(normal, eta_squared, eta_squared, 4.0);
    const double tangential = impact[Output::kWorkTangentialRestitution] / impact[Output::kWorkTangentialCompression];
    ExpectRelativelyNear(tangential, eta_squared, eta_squared, 4.0);
  }
}

// (40), second part: -Wr/Wc = kappa_hat^2.
TEST(PendulumIdentityTest, NewtonSquaredIsTheRatioOfTheTotalWorks) {
  for (const Impact& impact : EverydayImpacts()) {
    const double compression = impact[Output::kWorkNormalCompression] + impact[Output::kWorkTangentialCompression];
    const double restitution = impact[Output::kWorkNormalRestitution] + impact[Output::kWorkTangentialRestitution];
    const double newton = impact[Output::kNewton];
    ExpectRelativelyNear(-restitution / compression, newton * newton,
                         impact[Output::kWorkNormalRestitution] / compression, 8.0);
  }
}

// (41), (42)
TEST(PendulumIdentityTest, FrictionRatioIsTheRatioOfTangentialToNormalWork) {
  SceneSource source(42);
  for (int i = 0; i < kScenes; ++i) {
    const Problem problem = source.Everyday();
    const Impact impact = Solve(problem);
    const double x = problem.mu * std::fabs(problem.b) / problem.a;
    ExpectRelativelyNear(impact[Output::kWorkTangentialCompression], x * impact[Output::kWorkNormalCompression],
                         impact[Output::kWorkTangentialCompression], 4.0);
    ExpectRelativelyNear(impact[Output::kWorkTangentialRestitution], -x * impact[Output::kWorkNormalRestitution],
                         impact[Output::kWorkTangentialRestitution], 4.0);
    const double eta = impact[Output::kEnergetic];
    ExpectRelativelyNear(impact[Output::kWorkTangential] * (1.0 - eta * eta),
                         x * impact[Output::kWorkNormal] * (1.0 + eta * eta),
                         impact[Output::kWorkTangential] * (1.0 + eta * eta), 8.0);
  }
}

// (38)
TEST(PendulumIdentityTest, CompressionTakesAllTheKineticEnergy) {
  SceneSource source(38);
  for (int i = 0; i < kScenes; ++i) {
    const Problem problem = source.Everyday();
    const Impact impact = Solve(problem);
    const double energy = 0.5 * problem.inertia * problem.omega_minus * problem.omega_minus;
    ExpectRelativelyNear(impact[Output::kWorkNormalCompression] + impact[Output::kWorkTangentialCompression], -energy,
                         energy, 4.0);
  }
}

// (43)
TEST(PendulumIdentityTest, NewtonAndPoissonAreReciprocalWhereEtaIsOne) {
  SceneSource source(43);
  for (int i = 0; i < kScenes; ++i) {
    Problem problem = source.Everyday();
    problem.law = RestitutionLaw::kEnergetic;
    problem.coefficient = 1.0;
    const Impact impact = Solve(problem);
    if (impact.regime == Regime::kLocked) continue;
    ExpectRelativelyNear(impact[Output::kNewton] * impact[Output::kPoisson], 1.0, 1.0, 2.0);
    EXPECT_EQ(impact[Output::kWorkNormal], 0.0);
    EXPECT_EQ(impact[Output::kEnergeticExcess], 0.0);
    EXPECT_FALSE(impact.sharp_limit_broken);
  }
}

TEST(PendulumIdentityTest, MirroringTheContactFlipsTangentialSignsAndNothingElse) {
  const std::array<Output, 4> tangential = {Output::kTangentialCoefficient, Output::kTangentialVelocityAfter,
                                            Output::kTangentialImpulse, Output::kTangentialImpulseCompression};
  SceneSource source(4);
  for (int i = 0; i < kScenes; ++i) {
    Problem problem = source.Any();
    const Impact right = Solve(problem);
    problem.b = -problem.b;
    const Impact left = Solve(problem);
    for (int k = 0; k < kOutputCount; ++k) {
      const auto output = static_cast<Output>(k);
      const bool flips = std::find(tangential.begin(), tangential.end(), output) != tangential.end();
      EXPECT_EQ(left[output], flips ? -right[output] : right[output]) << OutputNames()[static_cast<size_t>(k)];
    }
    EXPECT_EQ(left.regime, right.regime);
  }
}

// Scaling mass, length and time by powers of two scales every output by the power that its unit says.
TEST(PendulumIdentityTest, ScalingUnitsByPowersOfTwoIsExact) {
  constexpr int kMass = 7;
  constexpr int kLength = -9;
  constexpr int kTime = 5;
  constexpr int kSpeed = kLength - kTime;
  constexpr int kImpulse = kMass + kSpeed;
  constexpr int kEnergy = kImpulse + kSpeed;
  const std::array<int, kOutputCount> powers = {0,        0,        0,        0,        -kTime,  kSpeed,  kSpeed,
                                                kImpulse, kImpulse, kImpulse, kImpulse, kEnergy, kEnergy, kEnergy,
                                                kEnergy,  kEnergy,  kEnergy,  kEnergy,  0};
  SceneSource source(2);
  for (int i = 0; i < kScenes; ++i) {
    Problem problem = source.Everyday();
    const Impact impact = Solve(problem);
    problem.inertia = std::ldexp(problem.inertia, kMass + 2 * kLength);
    problem.a = std::ldexp(problem.a, kLength);
    problem.b = std::ldexp(problem.b, kLength);
    problem.omega_minus = std::ldexp(problem.omega_minus, -kTime);
    const Impact scaled = Solve(problem);
    for (size_t k = 0; k < kOutputCount; ++k) {
      EXPECT_EQ(scaled.values[k], std::ldexp(impact.values[k], powers[k])) << OutputNames()[k];
    }
  }
}

// The path in Wide arithmetic, which extraordinary sizes take, gives the same bits as the path in DoubleDouble.
TEST(PendulumIdentityTest, SizesThatLeaveTheFastPathScaleExactlyToo) {
  constexpr int kMass = 120;
  SceneSource source(3);
  for (int i = 0; i < kScenes; ++i) {
    Problem problem = source.Everyday();
    const Impact impact = Solve(problem);
    problem.inertia = std::ldexp(problem.inertia, kMass);
    const Impact scaled = Solve(problem);
    for (const Output output : {Output::kNormalImpulse, Output::kTangentialImpulse, Output::kWorkNormal,
                                Output::kWorkTangential, Output::kEnergyChange}) {
      EXPECT_EQ(scaled[output], std::ldexp(impact[output], kMass)) << ToString(problem);
    }
    EXPECT_EQ(scaled[Output::kNewton], impact[Output::kNewton]);
  }
}

// ---- Regimes ----

TEST(PendulumRegimeTest, WithoutFrictionTheThreeCoefficientsAreEqualAndNothingHappensAlongTheSurface) {
  for (const RestitutionLaw law : {RestitutionLaw::kNewton, RestitutionLaw::kPoisson, RestitutionLaw::kEnergetic}) {
    const Impact impact = Solve(Make(0.7, 1.3, 0.0, law, 0.6));
    EXPECT_EQ(impact.regime, Regime::kFrictionless);
    EXPECT_EQ(impact[Output::kNewton], 0.6);
    EXPECT_EQ(impact[Output::kPoisson], 0.6);
    EXPECT_EQ(impact[Output::kEnergetic], 0.6);
    EXPECT_EQ(impact[Output::kTangentialCoefficient], 0.0);
    EXPECT_EQ(impact[Output::kTangentialImpulse], 0.0);
    EXPECT_EQ(impact[Output::kWorkTangential], 0.0);
  }
}

TEST(PendulumRegimeTest, ContactRightBesideThePinSlidesNowhereWhateverTheFriction) {
  for (const double b : {0.0, -0.0}) {
    const Impact impact = Solve(Make(0.7, b, 0.8, RestitutionLaw::kNewton, 0.6));
    EXPECT_EQ(impact.regime, Regime::kFrictionless);
    EXPECT_EQ(impact[Output::kPoisson], 0.6);
    for (const Output output :
         {Output::kTangentialCoefficient, Output::kTangentialImpulse, Output::kTangentialImpulseCompression,
          Output::kTangentialVelocityAfter, Output::kWorkTangentialCompression, Output::kWorkTangential}) {
      EXPECT_EQ(std::bit_cast<uint64_t>(impact[output]), 0U) << "not +0";
    }
  }
}

// Section 3: the contact sticks for mu >= a/b, equality included.
TEST(PendulumRegimeTest, LocksExactlyFromWhereFrictionReachesAOverB) {
  const double b = 5.0;
  const double a = 3.0;
  const double below = std::nextafter(0.5, 0.0);
  EXPECT_EQ(Solve(Make(2.5, b, 0.5, RestitutionLaw::kEnergetic, 1.0)).regime, Regime::kLocked);
  EXPECT_EQ(Solve(Make(2.5, b, below, RestitutionLaw::kEnergetic, 1.0)).regime, Regime::kRebound);
  // 0.6 as a double is below 3/5 by 2^-55: 5 x 0.6 < 3 although it rounds to 3.
  EXPECT_EQ(Solve(Make(a, b, 0.6, RestitutionLaw::kEnergetic, 1.0)).regime, Regime::kRebound);
  EXPECT_EQ(Solve(Make(a, b, std::nextafter(0.6, 1.0), RestitutionLaw::kEnergetic, 1.0)).regime, Regime::kLocked);
  // (1 + 2^-40)(1 - 2^-40) = 1 - 2^-80 < 1.
  EXPECT_EQ(Solve(Make(1.0, 1.0 + 0x1p-40, 1.0 - 0x1p-40, RestitutionLaw::kEnergetic, 1.0)).regime, Regime::kRebound);
}

// Section 6.1 with (8) and (42) for x > 1: there is compression only, and all energy is lost.
TEST(PendulumRegimeTest, LockedImpactEndsWithCompression) {
  for (const RestitutionLaw law : {RestitutionLaw::kNewton, RestitutionLaw::kPoisson, RestitutionLaw::kEnergetic}) {
    const Impact impact = Solve(Make(1.0, -4.0, 0.5, law, 1.0));
    EXPECT_EQ(impact.regime, Regime::kLocked);
    EXPECT_EQ(impact[Output::kNewton], 0.0);
    EXPECT_EQ(impact[Output::kPoisson], 0.0);
    EXPECT_EQ(impact[Output::kEnergetic], 0.0);
    EXPECT_EQ(impact[Output::kOmegaPlus], 0.0);
    EXPECT_EQ(impact[Output::kNormalImpulseCompression], 2.0);  // J w/(a + mu |b|) = 6/3
    EXPECT_EQ(impact[Output::kNormalImpulse], 2.0);
    EXPECT_EQ(impact[Output::kTangentialImpulse], -1.0);
    EXPECT_EQ(impact[Output::kTangentialCoefficient], -0.5);
    EXPECT_EQ(impact[Output::kWorkNormalCompression], -3.0);
    EXPECT_EQ(impact[Output::kWorkTangentialCompression], -6.0);
    EXPECT_EQ(impact[Output::kWorkNormalRestitution], 0.0);
    EXPECT_EQ(impact[Output::kWorkTangentialRestitution], 0.0);
    EXPECT_EQ(impact[Output::kEnergyChange], -9.0);
  }
}

TEST(PendulumRegimeTest, StaticFrictionLocksWhileCompressionSlidesWithKineticFriction) {
  Problem problem = Make(1.0, 2.0, 0.25, RestitutionLaw::kEnergetic, 1.0);
  problem.mu_static = 0.5;
  const Impact locked = Solve(problem);
  EXPECT_EQ(locked.regime, Regime::kLocked);
  EXPECT_EQ(locked[Output::kNormalImpulse], 4.0);  // 6/(1 + 0.25 x 2)
  EXPECT_EQ(locked[Output::kTangentialImpulse], 1.0);
  problem.mu_static = std::nextafter(0.5, 0.0);
  EXPECT_EQ(Solve(problem).regime, Regime::kRebound);
}

TEST(PendulumRegimeTest, AContactThatDoesNotApproachChangesNothing) {
  for (const double omega : {0.0, 2.5}) {
    Problem problem = Make(0.5, -2.0, 0.9, RestitutionLaw::kNewton, 0.7);
    problem.omega_minus = omega;
    const Impact impact = Solve(problem);
    EXPECT_EQ(impact.regime, Regime::kSeparating);
    EXPECT_EQ(impact[Output::kOmegaPlus], omega);
    EXPECT_EQ(impact[Output::kTangentialVelocityAfter], -2.0 * omega);
    EXPECT_EQ(impact[Output::kNormalVelocityAfter], 0.5 * omega);
    for (const Output output :
         {Output::kNewton, Output::kPoisson, Output::kEnergetic, Output::kTangentialCoefficient, Output::kNormalImpulse,
          Output::kTangentialImpulse, Output::kWorkNormal, Output::kWorkTangential, Output::kEnergyChange}) {
      EXPECT_EQ(impact[output], 0.0);
    }
    EXPECT_FALSE(impact.sharp_limit_broken);
    EXPECT_FALSE(impact.energy_limit_broken);
  }
}

TEST(PendulumRegimeTest, CoefficientZeroReboundsNotAtAllAndIsAdmissible) {
  for (const RestitutionLaw law : {RestitutionLaw::kNewton, RestitutionLaw::kPoisson, RestitutionLaw::kEnergetic}) {
    const Impact impact = Solve(Make(1.0, 1.0, 0.5, law, 0.0));
    EXPECT_EQ(impact.regime, Regime::kRebound);
    EXPECT_EQ(impact[Output::kPoisson], 0.0);
    EXPECT_EQ(impact[Output::kOmegaPlus], 0.0);
    EXPECT_EQ(impact[Output::kNormalImpulse], 4.0);
    EXPECT_EQ(impact[Output::kTangentialCoefficient], 0.5);
    EXPECT_FALSE(impact.sharp_limit_broken);
  }
}

// ---- Limits ----

// a = 5, mu b = 3: r = 1/4, so the sharp bounds are exactly 1/2 and 2.
TEST(PendulumLimitTest, CoefficientExactlyAtItsBoundIsAdmissibleAndOneUlpAboveIsNot) {
  struct Case {
    RestitutionLaw law;
    double bound;
  };
  for (const auto& [law, bound] : {Case{RestitutionLaw::kNewton, 0.5}, Case{RestitutionLaw::kPoisson, 2.0}}) {
    const Impact at = Solve(Make(5.0, 6.0, 0.5, law, bound));
    EXPECT_EQ(at[Output::kEnergetic], 1.0);
    EXPECT_EQ(at[Output::kEnergeticExcess], 0.0);
    EXPECT_EQ(at[Output::kWorkNormal], 0.0);
    EXPECT_FALSE(at.sharp_limit_broken);

    const Impact above = Solve(Make(5.0, 6.0, 0.5, law, std::nextafter(bound, 9.0)));
    EXPECT_TRUE(above.sharp_limit_broken);
    EXPECT_FALSE(above.energy_limit_broken);
    EXPECT_DOUBLE_EQ(above[Output::kEnergeticExcess], 0x1p-52);
  }
}

// mu b = p1 p2 2^-k = q (1 +- 2^-k/q) exactly, which is as close to a threshold as a product of two doubles can be.
struct NearProduct {
  double q;
  double p1, p2;
  int k;
  bool above;
};
constexpr NearProduct kNearProducts[] = {
    {1.0, 610562242913389.0, 8304808329971045.0, 102, true},  {1.0, 2278687531871131.0, 8900917444787565.0, 104, false},
    {3.0, 853321742194369.0, 4456644677663041.0, 100, true},  {3.0, 291237716166317.0, 1632236996440795.0, 97, false},
    {7.0, 3489910873728161.0, 5085261213056865.0, 101, true}, {7.0, 1357743690810939.0, 6535514958863629.0, 100, false},
    {15.0, 5456542988537.0, 6806177694665033.0, 91, true},    {15.0, 1503854026044671.0, 6322009541522689.0, 99, false},
};

Problem MakeNear(const NearProduct& near, double a, RestitutionLaw law, double coefficient) {
  return Make(a, near.p1 * 0x1p-50, std::ldexp(near.p2, 50 - near.k), law, coefficient);
}

TEST(PendulumLimitTest, LockingIsDecidedExactlyToTheLastBitOfTheProduct) {
  for (const NearProduct& near : kNearProducts) {
    const Regime expected = near.above ? Regime::kLocked : Regime::kRebound;
    EXPECT_EQ(Solve(MakeNear(near, near.q, RestitutionLaw::kEnergetic, 1.0)).regime, expected)
        << near.q << " " << near.above;
  }
}

// Newton's bound is exactly e where q/a = (1 - e^2)/(1 + e^2), and falls with q; Poisson's is 1/e and rises with q.
TEST(PendulumLimitTest, SharpLimitIsSeenFrom2ToTheMinus100OfTheTermsOn) {
  struct Case {
    double q, a, e;
  };
  for (const auto& [q, a, e] :
       {Case{3.0, 5.0, 0.5}, Case{7.0, 25.0, 0.75}, Case{15.0, 113.0, 0.875}, Case{15.0, 17.0, 0.25}}) {
    for (const NearProduct& near : kNearProducts) {
      if (near.q != q) continue;
      const Impact impact = Solve(MakeNear(near, a, RestitutionLaw::kNewton, e));
      EXPECT_EQ(impact.sharp_limit_broken, near.above) << e;
      EXPECT_EQ(impact[Output::kEnergeticExcess] > 0.0, near.above) << e;
      if (e == 0.75 || e == 0.875) continue;  // 1/e is not a double.
      EXPECT_EQ(Solve(MakeNear(near, a, RestitutionLaw::kPoisson, 1.0 / e)).sharp_limit_broken, !near.above) << e;
    }
  }
}

TEST(PendulumLimitTest, NewtonAboveOneCreatesEnergyAndBreaksBothLimits) {
  const Impact impact = Solve(Make(5.0, 6.0, 0.5, RestitutionLaw::kNewton, 1.25));
  EXPECT_TRUE(impact.sharp_limit_broken);
  EXPECT_TRUE(impact.energy_limit_broken);
  EXPECT_EQ(impact[Output::kEnergyChange], 9.0 * (1.25 * 1.25 - 1.0));
  EXPECT_EQ(impact[Output::kEnergetic], 2.5);
  EXPECT_EQ(impact[Output::kEnergeticExcess], 1.5);
}

// Kinetic energy alone allows Newton = 1 although the spring would have to give back four times what it stored.
TEST(PendulumLimitTest, NewtonBetweenTheSharpAndTheEnergyBoundBreaksTheSharpLimitOnly) {
  const Impact impact = Solve(Make(5.0, 6.0, 0.5, RestitutionLaw::kNewton, 1.0));
  EXPECT_TRUE(impact.sharp_limit_broken);
  EXPECT_FALSE(impact.energy_limit_broken);
  EXPECT_EQ(impact[Output::kEnergyChange], 0.0);
  EXPECT_EQ(impact[Output::kEnergetic], 2.0);
}

// (28): kappa = 1/r = 4 is where Poisson's coefficient begins to create energy.
TEST(PendulumLimitTest, PoissonBreaksTheEnergyLimitAboveOneOverR) {
  EXPECT_FALSE(Solve(Make(5.0, 6.0, 0.5, RestitutionLaw::kPoisson, 4.0)).energy_limit_broken);
  EXPECT_TRUE(Solve(Make(5.0, 6.0, 0.5, RestitutionLaw::kPoisson, std::nextafter(4.0, 9.0))).energy_limit_broken);
  EXPECT_GT(Solve(Make(5.0, 6.0, 0.5, RestitutionLaw::kPoisson, std::nextafter(4.0, 9.0)))[Output::kEnergyChange], 0.0);
}

TEST(PendulumLimitTest, EnergeticCoefficientIsNeverInadmissible) {
  SceneSource source(29);
  for (int i = 0; i < 10 * kScenes; ++i) {
    Problem problem = source.Any();
    problem.law = RestitutionLaw::kEnergetic;
    problem.coefficient = source.UnitByExponent();
    const Impact impact = Solve(problem);
    EXPECT_FALSE(impact.sharp_limit_broken) << ToString(problem);
    EXPECT_FALSE(impact.energy_limit_broken) << ToString(problem);
    EXPECT_LE(impact[Output::kEnergyChange], 0.0) << ToString(problem);
  }
}

TEST(PendulumLimitTest, LockedPendulumDoesNotUseItsCoefficient) {
  const Impact impact = Solve(Make(1.0, 4.0, 0.5, RestitutionLaw::kNewton, 7.0));
  EXPECT_EQ(impact.regime, Regime::kLocked);
  EXPECT_FALSE(impact.sharp_limit_broken);
  EXPECT_FALSE(impact.energy_limit_broken);
}

TEST(PendulumLimitTest, ExactValuesAboveTheLargestDoubleComeOutInfinite) {
  Problem problem = Make(1.0, 1.0, 0.5, RestitutionLaw::kEnergetic, 1.0);
  problem.inertia = 1e200;
  problem.omega_minus = -1e200;
  const Impact impact = Solve(problem);
  EXPECT_EQ(impact[Output::kNormalImpulse], std::numeric_limits<double>::infinity());
  EXPECT_EQ(impact[Output::kEnergyChange], -std::numeric_limits<double>::infinity());
  EXPECT_NEAR(impact[Output::kNewton], std::sqrt(1.0 / 3.0), 1e-15);
}

TEST(PendulumLimitTest, ProductsThatLeaveTheRangeOfDoublesOnTheWayDoNoHarm) {
  Problem problem = Make(1e-300, 1e-300, 0.5, RestitutionLaw::kEnergetic, 1.0);
  problem.inertia = 1e-300;
  const Impact impact = Solve(problem);
  EXPECT_NEAR(impact[Output::kNormalImpulseCompression], 2.0, 1e-15);
  EXPECT_NEAR(impact[Output::kNewton], std::sqrt(1.0 / 3.0), 1e-15);
}

// ---- Histories ----

// Fig. 3: two straight lines through (0, omega-), (tau0, 0), (tau1, omega+).
TEST(PendulumHistoryTest, AngularVelocityIsBilinearAndVanishesAtTheEndOfCompression) {
  const Problem problem = Make(0.75, 1.0, 0.25, RestitutionLaw::kPoisson, 1.0);  // tau0 = 6, r = 1/2
  EXPECT_EQ(At(problem, 0.0).omega, -3.0);
  EXPECT_EQ(At(problem, 3.0).omega, -1.5);
  EXPECT_EQ(At(problem, 6.0).omega, 0.0);
  EXPECT_EQ(At(problem, 9.0).omega, 0.75);
  EXPECT_EQ(At(problem, 12.0).omega, 1.5);
  EXPECT_EQ(Solve(problem)[Output::kOmegaPlus], 1.5);
}

// Fig. 5 (b), Routh's diagram: up with mu, then down with mu; mirrored for b < 0.
TEST(PendulumHistoryTest, FrictionImpulseRisesToTheEndOfCompressionAndFallsFromThere) {
  for (const double sign : {1.0, -1.0}) {
    const Problem problem = Make(0.75, sign, 0.25, RestitutionLaw::kPoisson, 1.0);
    EXPECT_EQ(At(problem, 0.0).tangential_impulse, 0.0);
    EXPECT_EQ(At(problem, 3.0).tangential_impulse, sign * 0.75);
    EXPECT_EQ(At(problem, 6.0).tangential_impulse, sign * 1.5);
    EXPECT_EQ(At(problem, 9.0).tangential_impulse, sign * 0.75);
    EXPECT_EQ(At(problem, 12.0).tangential_impulse, 0.0);
  }
}

TEST(PendulumHistoryTest, WithoutSlipThereIsNoFrictionImpulseAtAnyTime) {
  const Problem problem = Make(0.75, 0.0, 0.25, RestitutionLaw::kPoisson, 1.0);  // tau0 = 8
  EXPECT_EQ(At(problem, 4.0).tangential_impulse, 0.0);
  EXPECT_EQ(At(problem, 12.0).tangential_impulse, 0.0);
  EXPECT_EQ(At(problem, 12.0).omega, 1.5);
}

}  // namespace
}  // namespace ricochet::pendulum
