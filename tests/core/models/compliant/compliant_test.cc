// The compliant model: published numbers, an experiment, the ledger, limits, wedging, and a second method.

#include "core/models/compliant/compliant.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>

#include "core/models/planar/planar.h"
#include "tests/support/scenes/compliant_scenes.h"

namespace ricochet::compliant {
namespace {

constexpr int kScenes = 100'000;

double Speed(const Problem& problem) { return std::max(std::fabs(problem.contact.u0), std::fabs(problem.contact.v0)); }

double LargestWork(const Impact& impact) {
  return std::max({std::fabs(impact.work_normal_compression), std::fabs(impact.work_normal_restitution),
                   std::fabs(impact.work_tangential_compression), std::fabs(impact.work_tangential_restitution)});
}

double TangentialWork(const Impact& impact) {
  return impact.work_tangential_compression + impact.work_tangential_restitution;
}

// A sphere and a flat of the same material, unit mass: Wtt/Wnn = 7/2, ratio^2 = (2 - nu)/(2 (1 - nu)) (Mindlin).
Problem Sphere(double u0, double v0, double mu, double eta, double nu) {
  return {.contact = {.w = {3.5, 0.0, 1.0}, .u0 = u0, .v0 = v0, .mu = mu, .coefficient = eta},
          .ratio_squared = (2.0 - nu) / (2.0 * (1.0 - nu))};
}

Problem Contact(double wtt, double wtn, double wnn, double u0, double mu, double eta, double ratio_squared) {
  return {.contact = {.w = {wtt, wtn, wnn}, .u0 = u0, .v0 = -1.0, .mu = mu, .coefficient = eta},
          .ratio_squared = ratio_squared};
}

// -- Numbers of others --

struct SphereRow {
  double eta, before, after;
};

// psi = u/(mu |v0|) at nu = 0.3, from an independent implementation at 40 digits.
TEST(CompliantSphereTest, SlipAfterIsThatOfTheTables) {
  constexpr SphereRow kRows[] = {{1.0, 1.0, .202717212591},  {1.0, 2.0, -.584870663568}, {1.0, 3.0, -1.36179780865},
                                 {1.0, 5.0, -1.70290384157}, {1.0, 6.0, -1.0},           {0.5, 2.0, -1.61924411268},
                                 {0.5, 3.0, -2.02906718931}, {0.5, 4.0, -1.25}};
  for (const SphereRow& row : kRows) {
    constexpr double kMu = 0.25;
    const Impact impact = Solve(Sphere(row.before * kMu, -1.0, kMu, row.eta, 0.3));
    EXPECT_NEAR(impact.u1 / kMu, row.after, 1e-11) << row.eta << " " << row.before;
    EXPECT_NEAR(impact.v1, row.eta, 1e-15);
  }
}

// The velocity of the sphere's centre along the surface, after over before: no spin before.
double TangentialRestitution(const Problem& problem, double f1) { return 1.0 + f1 / problem.contact.u0; }

struct KharazRow {
  double degrees, measured, rigid;
};

// Kharaz, Gorham and Salman (2001), alumina spheres of 2.5 mm on glass at 3.9 m/s: mu = 0.092, e = 0.98; nu = 0.23 for
// both materials.
TEST(CompliantKharazTest, TwentyDegreesNeedsTheSpringAndFiftyDoesNot) {
  constexpr KharazRow kRows[] = {{20.2, .599, .714}, {30.4, .690, .714}, {49.6, .848, .847}};
  std::array<double, 3> lumped = {};
  for (size_t i = 0; i < 3; ++i) {
    const double angle = kRows[i].degrees * M_PI / 180.0;
    const Problem problem = Sphere(3.9 * std::sin(angle), -3.9 * std::cos(angle), 0.092, 0.98, 0.23);
    lumped[i] = TangentialRestitution(problem, Solve(problem).f1);
    const planar::Problem rigid = {.w = {problem.contact.w.tt, 0.0, problem.contact.w.nn},
                                   .u0 = problem.contact.u0,
                                   .v0 = problem.contact.v0,
                                   .mu = problem.contact.mu,
                                   .mu_static = problem.contact.mu,
                                   .coefficient = problem.contact.coefficient};
    // mu has two digits.
    EXPECT_NEAR(TangentialRestitution(problem, planar::Solve(rigid).f1), kRows[i].rigid, 2.5e-3);
    EXPECT_NEAR(lumped[i], kRows[i].measured, 0.011 * kRows[i].measured) << kRows[i].degrees;
  }
  EXPECT_NEAR(lumped[0], .592, 1e-3);
  EXPECT_GT(kRows[0].rigid / kRows[0].measured, 1.19);
}

// -- What holds for every impact --

class CompliantIdentityTest : public testing::Test {
 protected:
  // The size of the rounding errors of the terms of P . (v- + v+)/2.
  static double EnergyRounding(const Problem& p, const Impact& impact) {
    return 1e-14 * (std::fabs(impact.f1) * (std::fabs(p.contact.u0) + std::fabs(impact.u1)) +
                    impact.tau1 * (std::fabs(p.contact.v0) + impact.v1) + LargestWork(impact));
  }
};

// Change of energy less what the tangential force did, which comes from deflection and slip.
TEST_F(CompliantIdentityTest, NormalWorkReturnsEtaSquaredOfWhatCompressionTookByVelocitiesAndImpulses) {
  SceneSource scenes(1);
  for (int i = 0; i < kScenes / 10; ++i) {
    const Problem problem = scenes.Everyday(0.02, 4.0);
    const Impact impact = Solve(problem);
    const double normal = impact.energy_change - TangentialWork(impact);
    const double expected =
        (1.0 - problem.contact.coefficient * problem.contact.coefficient) * impact.work_normal_compression;
    ASSERT_NEAR(normal, expected, EnergyRounding(problem, impact)) << i;
    ASSERT_EQ(impact.energetic, problem.contact.coefficient);
    ASSERT_NEAR(-impact.work_normal_restitution / impact.work_normal_compression,
                problem.contact.coefficient * problem.contact.coefficient, 1e-15);
  }
}

TEST_F(CompliantIdentityTest, TangentialWorkIsWhatFrictionAndTheSpringTake) {
  SceneSource scenes(2);
  for (int i = 0; i < kScenes / 10; ++i) {
    const Impact impact = Solve(scenes.Everyday(1e-3, 1e2));
    ASSERT_GE(impact.friction_dissipation, 0.0);
    ASSERT_GE(impact.spring_energy, 0.0);
    ASSERT_NEAR(TangentialWork(impact), -(impact.friction_dissipation + impact.spring_energy),
                1e-15 * LargestWork(impact))
        << i;
  }
}

// A velocity beside the range of W, on a contact that sticks at once: no impulse is reached, and no ratio of impulses.
TEST(CompliantTest, AnImpactThatIsWedgedAtOnceHasNoTangentialCoefficient) {
  const Impact impact = Solve(
      {.contact = {.w = {1.0, 1.0, 1.0}, .u0 = 0.0, .v0 = -1.0, .mu = 2.0, .coefficient = 1.0}, .ratio_squared = 1.0});
  EXPECT_EQ(impact.regime, Regime::kWedged);
  EXPECT_EQ(impact.tangential, 0.0);
}

// The steeper the cone, the less of N is left where the particle breaks away, and the more of rounding in it.
TEST_F(CompliantIdentityTest, TheLedgerClosesAtTheTipOfASteepCone) {
  for (const double wtt : {4.0, 5.0}) {
    for (double mu = 10.0; mu < 1e16; mu *= 7.0) {
      const Impact impact =
          Solve({.contact = {.w = {wtt, 2.0, 1.0}, .u0 = -2.0, .v0 = -1.0, .mu = mu, .coefficient = 0.8},
                 .ratio_squared = 5.2});
      ASSERT_NE(impact.regime, Regime::kWedged);
      const double works = impact.work_normal_compression + impact.work_normal_restitution + TangentialWork(impact);
      EXPECT_NEAR(works, impact.energy_change, 4e-15 * LargestWork(impact)) << wtt << ", " << mu;
    }
  }
}

// The particle sticks to the end, where what the spring has left is lost.
TEST_F(CompliantIdentityTest, TheLedgerClosesWhereFrictionIsBeyondAllNumbers) {
  for (const double mu : {1e20, 1e100, 3e298}) {
    for (const double u0 : {-1.0, 1.0}) {
      const Impact impact =
          Solve({.contact = {.w = {1.0, 0.1, 1.0}, .u0 = u0, .v0 = -1.0, .mu = mu, .coefficient = 1.0},
                 .ratio_squared = 0.3});
      const double works = impact.work_normal_compression + impact.work_normal_restitution + TangentialWork(impact);
      EXPECT_NEAR(works, impact.energy_change, 4e-15 * LargestWork(impact)) << mu;
      EXPECT_LT(impact.energy_change, -0.01);
    }
  }
}

// Velocities come from the oscillations, impulses from their integrals.
TEST_F(CompliantIdentityTest, ImpulsesMakeTheChangeOfVelocity) {
  SceneSource scenes(3);
  for (int i = 0; i < kScenes / 10; ++i) {
    const Problem p = scenes.Everyday(0.02, 4.0);
    const Impact impact = Solve(p);
    const double scale =
        Speed(p) + impact.tau1 * (p.contact.mu * p.contact.w.tt + std::fabs(p.contact.w.tn) + p.contact.w.nn);
    ASSERT_NEAR(impact.u1, p.contact.u0 + p.contact.w.tt * impact.f1 + p.contact.w.tn * impact.tau1, 1e-14 * scale)
        << i;
    ASSERT_NEAR(impact.v1, p.contact.v0 + p.contact.w.tn * impact.f1 + p.contact.w.nn * impact.tau1, 1e-14 * scale)
        << i;
  }
}

TEST_F(CompliantIdentityTest, EveryImpactEndsInsideTheConeWithoutAGainOfEnergy) {
  SceneSource scenes(4);
  size_t most = 0;
  for (int i = 0; i < kScenes; ++i) {
    const Problem problem = scenes.Everyday(1e-3, 1e3);
    const Impact impact = Solve(problem);
    ASSERT_NE(impact.regime, Regime::kWedged) << i;
    ASSERT_LE(std::fabs(impact.f1), problem.contact.mu * impact.tau1 * (1.0 + 1e-14));
    ASSERT_LE(impact.energy_change, 0.0);
    ASSERT_LE(impact.work_normal_compression + impact.work_normal_restitution + TangentialWork(impact), 0.0);
    ASSERT_GE(impact.v1, 0.0);
    ASSERT_FALSE(impact.sharp_limit_broken || impact.energy_limit_broken);
    most = std::max(most, impact.sections.size());
  }
  std::printf("  %zu sections at most\n", most);
  EXPECT_LT(most, static_cast<size_t>(kMaxSections / 50));
}

TEST_F(CompliantIdentityTest, SectionsFollowOneAnotherAndSlipNeverTurnsWithoutAStick) {
  SceneSource scenes(5);
  for (int i = 0; i < kScenes / 10; ++i) {
    const Impact impact = Solve(scenes.Everyday(1e-3, 1e1));
    ASSERT_TRUE(impact.sections.front().first_loading);
    ASSERT_FALSE(impact.sections.back().first_loading || impact.sections.back().indenting);
    for (size_t j = 1; j < impact.sections.size(); ++j) {
      const Section& before = impact.sections[j - 1];
      const Section& section = impact.sections[j];
      ASSERT_GE(section.tau, before.tau);
      ASSERT_TRUE(section.friction == before.friction || section.friction == FrictionState::kStick ||
                  before.friction == FrictionState::kStick);
      ASSERT_TRUE(!section.first_loading || section.indenting);
      ASSERT_TRUE(section.indenting ? section.v <= 0.0 : section.v >= 0.0);
    }
  }
}

TEST_F(CompliantIdentityTest, VelocityTurnsMoreThanOnceOnlyWhereFrictionCanPushTheBodyIn) {
  SceneSource scenes(6);
  int pushed_in = 0;
  for (int i = 0; i < kScenes / 10; ++i) {
    const Problem problem = scenes.Everyday(0.02, 4.0);
    const Impact impact = Solve(problem);
    bool again = false;
    for (const Section& section : impact.sections) again |= section.indenting && !section.first_loading;
    if (!again) continue;
    ASSERT_GT(problem.contact.mu * std::fabs(problem.contact.w.tn), problem.contact.w.nn) << i;
    ++pushed_in;
  }
  EXPECT_GT(pushed_in, 0);
}

TEST_F(CompliantIdentityTest, UnitsAndTheSideOfTheContactDoNotMatterToAnyBit) {
  SceneSource scenes(7);
  for (int i = 0; i < 1000; ++i) {
    const Problem problem = scenes.Everyday(0.02, 4.0);
    Problem other = problem;
    for (double* w : {&other.contact.w.tt, &other.contact.w.tn, &other.contact.w.nn}) *w = std::scalbn(*w, 600);
    for (double* speed : {&other.contact.u0, &other.contact.v0}) *speed = std::scalbn(*speed, -300);
    other.contact.w.tn = -other.contact.w.tn;
    other.contact.u0 = -other.contact.u0;
    const Impact impact = Solve(problem);
    const Impact mirrored = Solve(other);
    ASSERT_EQ(impact.sections.size(), mirrored.sections.size());
    ASSERT_EQ(impact.u1, -std::scalbn(mirrored.u1, 300));
    ASSERT_EQ(impact.v1, std::scalbn(mirrored.v1, 300));
    ASSERT_EQ(impact.tau1, std::scalbn(mirrored.tau1, 900));
  }
}

// Five times W and the velocities, all exact, is the same impact; but hardly a rounding is.
TEST(CompliantAccuracyTest, TheEstimateCoversTheDifferenceThatOtherRoundingsMake) {
  SceneSource scenes(8);
  double largest = 0.0;
  for (int i = 0; i < kScenes / 4; ++i) {
    const Problem problem = i % 50 == 0 ? scenes.NearRankOne() : scenes.Everyday(1e-3, 1e3);
    Problem other = problem;
    for (double* number :
         {&other.contact.w.tt, &other.contact.w.tn, &other.contact.w.nn, &other.contact.u0, &other.contact.v0})
      *number *= 5.0;
    const Impact impact = Solve(problem);
    const Impact peer = Solve(other);
    const double difference = std::max(std::fabs(impact.u1 - peer.u1 / 5.0), std::fabs(impact.v1 - peer.v1 / 5.0));
    ASSERT_LE(difference, (impact.error_estimate + peer.error_estimate) * Speed(problem)) << i;
    if (i % 50 != 0) largest = std::max(largest, impact.error_estimate);
  }
  std::printf("  largest estimate away from rank one %.2e\n", largest);
  EXPECT_LE(largest, 1e-8);
}

// -- A second method --

// The contact in small steps of time. The tangential force follows the body like an elastic force that yields at the
// cone, clipped after each step: no mode, no event, no rule at S = 0.
class SmallSteps {
 public:
  SmallSteps(const Problem& problem, double step)
      : problem_(problem), step_(step), u_(problem.contact.u0), v_(problem.contact.v0) {}

  void Run(double longest) {
    for (double t = 0.0; t < longest && (t == 0.0 || d_ > least_); t += step_) Step();
  }

  double u() const { return u_; }
  double v() const { return v_; }
  bool touches() const { return d_ > least_; }

 private:
  void Step() {
    Kick();
    d_ -= v_ * step_;
    if (d_ > max_) {
      max_ = d_;
      least_ = max_ * (1.0 - problem_.contact.coefficient * problem_.contact.coefficient);
    }
    n_ = std::max(0.0, max_ - (max_ - d_) / (problem_.contact.coefficient * problem_.contact.coefficient));
    const double most = problem_.contact.mu * n_;
    p_ = std::clamp(p_ + u_ * step_ / problem_.ratio_squared, -most, most);
    Kick();
  }

  void Kick() {
    u_ += 0.5 * step_ * (problem_.contact.w.tn * n_ - problem_.contact.w.tt * p_);
    v_ += 0.5 * step_ * (problem_.contact.w.nn * n_ - problem_.contact.w.tn * p_);
  }

  Problem problem_;
  double step_;
  double u_, v_;
  double n_ = 0.0, p_ = 0.0, d_ = 0.0, max_ = 0.0, least_ = 0.0;
};

TEST(CompliantSecondMethodTest, SmallStepsOfTimeComeToTheSameEnd) {
  SceneSource scenes(9);
  double worst = 0.0;
  for (int i = 0; i < 40; ++i) {
    const Problem problem = i % 4 == 0 ? scenes.RankOne() : scenes.Everyday(0.1, 4.0);
    const Impact impact = Solve(problem);
    if (impact.regime == Regime::kWedged) continue;
    const double slowest = 1.0 / std::sqrt(problem.contact.w.nn);
    const double step = 2e-5 * slowest * std::min(1.0, problem.contact.coefficient);
    SmallSteps coarse(problem, 4.0 * step);
    SmallSteps fine(problem, step);
    coarse.Run(1e3 * slowest);
    fine.Run(1e3 * slowest);
    ASSERT_FALSE(fine.touches()) << i;
    const double speed = Speed(problem);
    const double own_error = std::max(std::fabs(fine.u() - coarse.u()), std::fabs(fine.v() - coarse.v())) / speed;
    const double difference = std::max(std::fabs(fine.u() - impact.u1), std::fabs(fine.v() - impact.v1)) / speed;
    EXPECT_LE(difference, own_error + 1e-8) << i;
    EXPECT_LE(own_error, 5e-4) << i;
    worst = std::max(worst, difference);
  }
  std::printf("  worst difference %.2e\n", worst);
}

// -- Limits --

struct LimitCase {
  const char* name;
  Regime regime;  // The regime of the rigid contact.
  double wtt, wtn, wnn, u0, mu, eta;
  double order;              // The velocities err by ratio to this power; 0: not at all.
  double compression_order;  // The impulse of compression errs by this power of ratio.
};

planar::Impact Rigid(const LimitCase& c) {
  return planar::Solve(
      {.w = {c.wtt, c.wtn, c.wnn}, .u0 = c.u0, .v0 = -1.0, .mu = c.mu, .mu_static = c.mu, .coefficient = c.eta});
}

struct Envelope {
  double velocity = 0.0, compression = 0.0;
};

// The largest errors against the rigid impact for ratios over half a decade below `ratio`.
Envelope EnvelopeBelow(double ratio, const LimitCase& c, const planar::Impact& rigid) {
  constexpr int kSamples = 16;
  Envelope envelope;
  for (int i = 0; i < kSamples; ++i) {
    const double r = ratio * std::pow(10.0, -0.5 * i / kSamples);
    const Impact impact = Solve(Contact(c.wtt, c.wtn, c.wnn, c.u0, c.mu, c.eta, r * r));
    EXPECT_EQ(impact.regime, c.regime) << c.name << " " << r;
    envelope.velocity = std::max({envelope.velocity, std::fabs(impact.u1 - rigid.u1), std::fabs(impact.v1 - rigid.v1)});
    envelope.compression = std::max(envelope.compression, std::fabs(impact.tau_compression - rigid.tau_compression));
  }
  return envelope;
}

TEST(CompliantLimitTest, TheRigidImpactReturnsAsTheRatioVanishesInTheOrderOfHowItEnds) {
  const LimitCase kCases[] = {
      {"slides", Regime::kSliding, 3.0, 0.4, 1.0, 8.0, 0.3, 0.7, 0.0, 0.0},
      {"sticks in compression", Regime::kStickInCompression, 2.5, 0.5, 2.5, -0.5, 0.7, 0.6, 2.0, 1.0},
      {"sticks in compression, Wtn < 0", Regime::kStickInCompression, 2.5, -0.5, 2.0, 0.5, 0.7, 0.8, 2.0, 1.0},
      {"reverses in compression", Regime::kReversalInCompression, 1.0, 0.9, 1.5, -0.5, 0.4, 0.6, 1.0, 1.0},
      {"reverses in restitution", Regime::kReversalInRestitution, 1.0, 0.9, 1.5, -0.9, 0.4, 0.6, 1.0, 0.0},
      {"sticks in restitution", Regime::kStickInRestitution, 2.5, 0.3, 1.0, 1.6, 0.5, 0.8, 2.0, 0.0},
  };
  for (const LimitCase& c : kCases) {
    const planar::Impact rigid = Rigid(c);
    ASSERT_EQ(rigid.regime, c.regime) << c.name;
    const Envelope large = EnvelopeBelow(6e-2, c, rigid);
    const Envelope small = EnvelopeBelow(6e-5, c, rigid);
    const auto expect_order = [&](double order, double from, double to, const char* what) {
      if (order == 0.0) {
        EXPECT_LE(from, 1e-15) << c.name << ", " << what;
        return;
      }
      const double measured = std::log10(from / to) / 3.0;
      std::printf("  %s, %s: order %.3f\n", c.name, what, measured);
      EXPECT_NEAR(measured, order, 0.1) << c.name << ", " << what;
    };
    expect_order(c.order, large.velocity, small.velocity, "velocity");
    expect_order(c.compression_order, large.compression, small.compression, "impulse of compression");
  }
}

TEST(CompliantLimitTest, AnEndlesslySoftTangentialSpringIsNoFriction) {
  SceneSource scenes(10);
  for (int i = 0; i < 300; ++i) {
    Problem problem = scenes.Everyday(1.0, 2.0);
    problem.contact.mu += 0.1;
    Problem smooth = problem;
    smooth.contact.mu = 0.0;
    const Impact limit = Solve(smooth);
    for (const double ratio_squared : {1e4, 1e8, 1e12, 1e300}) {
      problem.ratio_squared = ratio_squared;
      const Impact impact = Solve(problem);
      const double difference =
          std::max(std::fabs(impact.u1 - limit.u1), std::fabs(impact.v1 - limit.v1)) / Speed(problem);
      // The deflection is of order u/sqrt(Wnn), and 1/ratio^2 multiplies it.
      ASSERT_LE(difference, 1e4 / ratio_squared + impact.error_estimate) << i << " " << ratio_squared;
    }
  }
}

TEST(CompliantLimitTest, WithoutFrictionNoTangentialForceActsAndNothingIsSearchedFor) {
  Problem problem = Contact(2.0, 0.7, 1.5, -0.4, 0.0, 0.6, 1.0);
  const Impact impact = Solve(problem);
  EXPECT_EQ(impact.regime, Regime::kFrictionless);
  EXPECT_EQ(impact.f1, 0.0);
  EXPECT_EQ(TangentialWork(impact), 0.0);
  EXPECT_NEAR(impact.v1, 0.6, 1e-15);
  EXPECT_NEAR(impact.tau1, 1.6 / 1.5, 1e-15);
  EXPECT_NEAR(impact.u1, -0.4 + 0.7 * 1.6 / 1.5, 1e-15);
  for (const Section& section : impact.sections) EXPECT_NE(section.friction, FrictionState::kStick);
  problem.ratio_squared = 1e-5;
  EXPECT_EQ(Solve(problem).u1, impact.u1);
}

// -- Corners --

TEST(CompliantCornerTest, ContactThatDoesNotApproachIsLeftAlone) {
  Problem problem = Contact(2.0, 0.7, 1.5, -0.4, 0.3, 0.6, 1.0);
  problem.contact.v0 = 0.0;
  const Impact impact = Solve(problem);
  EXPECT_EQ(impact.regime, Regime::kSeparating);
  EXPECT_EQ(impact.u1, -0.4);
  EXPECT_EQ(impact.v1, 0.0);
  EXPECT_TRUE(impact.sections.empty());
}

TEST(CompliantCornerTest, WithoutRestitutionTheImpactEndsAtRestAndTheSpringsEnergyIsLost) {
  const Impact impact = Solve(Contact(2.5, 0.5, 2.5, -0.1, 0.7, 0.0, 1.0));
  EXPECT_EQ(impact.v1, 0.0);
  EXPECT_EQ(impact.tau1, impact.tau_compression);
  EXPECT_GT(impact.spring_energy, 0.0);
  EXPECT_NEAR(impact.energy_change, impact.work_normal_compression - impact.friction_dissipation - impact.spring_energy,
              1e-15);
  EXPECT_EQ(impact.work_normal_restitution, 0.0);
  EXPECT_EQ(impact.newton, 0.0);
  EXPECT_EQ(impact.poisson, 0.0);
}

TEST(CompliantCornerTest, VanishingRestitutionComesToTheVelocitiesOfNone) {
  const Impact none = Solve(Contact(2.5, 0.5, 2.5, -0.1, 0.7, 0.0, 1.0));
  for (const double eta : {1e-30, 1e-59, 1e-61, 1e-300}) {
    const Impact impact = Solve(Contact(2.5, 0.5, 2.5, -0.1, 0.7, eta, 1.0));
    EXPECT_NEAR(impact.u1, none.u1, 1e-15) << eta;
    EXPECT_NEAR(impact.v1, 0.0, 2.0 * eta) << eta;
    EXPECT_NEAR(impact.tau1, none.tau1, 1e-15) << eta;
    EXPECT_EQ(impact.energetic, eta);
  }
}

// Exponents that a double's oscillations cannot follow may use up the budget, but nothing hangs and nothing is NaN.
TEST(CompliantCornerTest, NumbersOfAllSizesEndInNumbers) {
  SceneSource scenes(13);
  for (int i = 0; i < 200; ++i) {
    Problem problem = scenes.Everyday(0.02, 4.0);
    const double size = std::pow(10.0, scenes.Uniform(-100.0, 100.0));
    switch (i % 4) {
      case 0:
        problem.ratio_squared = size;
        break;
      case 1:
        problem.contact.mu = size;
        break;
      case 2:
        problem.contact.u0 *= std::sqrt(size);
        break;
      default:
        problem.contact.w.tt *= size;
        problem.contact.w.tn *= std::sqrt(size);
    }
    const Impact impact = Solve(problem);
    ASSERT_TRUE(std::isfinite(impact.u1) && std::isfinite(impact.v1) && std::isfinite(impact.tau1)) << i;
    ASSERT_FALSE(std::isnan(impact.f1) || std::isnan(impact.energy_change)) << i;
    ASSERT_FALSE(std::isnan(impact.error_estimate)) << i;
  }
}

// A wedged body has a state, which is finite; an overflow has none.
TEST(CompliantCornerTest, APathThatOverflowsHasNoVelocitiesAndUsesUpNoBudget) {
  const Impact impact =
      Solve({.contact = {.w = {2.0, -0.9, 1.5}, .u0 = -1.2e152, .v0 = -0.85, .mu = 1.7e305, .coefficient = 0.15},
             .ratio_squared = 2.9});
  EXPECT_TRUE(std::isnan(impact.u1) && std::isnan(impact.v1));
  EXPECT_LE(impact.sections.size(), 2U);
}

TEST(CompliantCornerTest, BodyThatCannotMoveAlongTheSurfaceKeepsItsSlip) {
  const Impact impact = Solve(Contact(0.0, 0.0, 2.0, 0.3, 0.5, 0.8, 1.3));
  EXPECT_EQ(impact.w_rank, 1);
  EXPECT_EQ(impact.u1, 0.3);
  EXPECT_NEAR(impact.v1, 0.8, 1e-15);
  EXPECT_NEAR(impact.tau1, 0.9, 1e-15);
  EXPECT_NEAR(impact.energy_change, 0.3 * impact.f1 - 0.5 * (1.0 - 0.64) / 2.0, 1e-15);
}

TEST(CompliantCornerTest, NormalImpactOfASphereSticksToTheEnd) {
  const Impact impact = Solve(Sphere(0.0, -2.0, 0.3, 0.7, 0.3));
  EXPECT_EQ(impact.sections.size(), 2U);
  EXPECT_EQ(impact.u1, 0.0);
  EXPECT_NEAR(impact.v1, 1.4, 1e-15);
  EXPECT_EQ(impact.f1, 0.0);
  EXPECT_EQ(impact.regime, Regime::kStickInCompression);
}

// S = |u0| - mu ratio^2 |v0| = 0: the sign of A decides.
TEST(CompliantCornerTest, StartOnTheConeSlidesWhereSlipGrowsAndSticksWhereItShrinks) {
  EXPECT_EQ(Solve(Contact(0.25, 0.0, 1.0, 0.5, 0.5, 0.6, 1.0)).sections.front().friction, FrictionState::kSlideForward);
  EXPECT_EQ(Solve(Contact(3.5, 0.0, 1.0, 0.5, 0.5, 0.6, 1.0)).sections.front().friction, FrictionState::kStick);
}

// At rank one slip stops where v does: u = v Wtn/Wnn.
TEST(CompliantCornerTest, PendulumSlipsToTheEndOfCompressionAndGoesOnByTheSignOfA) {
  const double b = 0.5;
  Problem problem = Contact(b * b, b, 1.0, -b, 0.3, 0.5, 1.0);
  const Impact slides = Solve(problem);
  ASSERT_EQ(slides.sections.size(), 2U);
  EXPECT_EQ(slides.sections[1].friction, FrictionState::kSlideBackward) << "A > 0 on the steep line of unloading";
  EXPECT_EQ(slides.sections[1].v, 0.0);
  problem.contact.coefficient = 1.0;
  EXPECT_EQ(Solve(problem).sections[1].friction, FrictionState::kStick);
}

bool IsEmpty(const Section& section, const Section& next) {
  return next.friction == section.friction && next.first_loading == section.first_loading &&
         next.indenting == section.indenting && next.tau == section.tau;
}

int EmptySections(const Impact& impact) {
  int empty = 0;
  for (size_t i = 1; i < impact.sections.size(); ++i) {
    empty += IsEmpty(impact.sections[i - 1], impact.sections[i]) ? 1 : 0;
  }
  return empty;
}

// So little friction that no impulse of it, mu tau at most, moves the end by more than the bounds.
TEST(CompliantCornerTest, SlipThatStopsWithinRoundingOfTheEndOfCompressionGoesOn) {
  const Problem problem = {.contact = {.w = {799.47564555592942, -0.079929156042974528, 56.324427762804198},
                                       .u0 = 0.12385403736785695,
                                       .v0 = -87.219844328824038,
                                       .mu = 6.5957619238675615e-08,
                                       .coefficient = 0.3705742415836551},
                           .ratio_squared = 0.18014975854623022};
  const Impact impact = Solve(problem);
  EXPECT_EQ(impact.regime, Regime::kReversalInCompression);
  EXPECT_EQ(impact.sections.size(), 4U);
  EXPECT_EQ(EmptySections(impact), 0);
  const double tau = -problem.contact.v0 * (1.0 + problem.contact.coefficient) / problem.contact.w.nn;
  const double f = problem.contact.mu * tau * (1.0 + 1e-6);
  EXPECT_NEAR(impact.tau1, tau, std::fabs(problem.contact.w.tn) * f / problem.contact.w.nn);
  EXPECT_NEAR(impact.v1, -problem.contact.coefficient * problem.contact.v0, std::fabs(problem.contact.w.tn) * f);
  EXPECT_NEAR(impact.u1, problem.contact.u0 + problem.contact.w.tn * tau, problem.contact.w.tt * f);
  EXPECT_LE(impact.error_estimate, 1e-12);
}

// -- Wedging --

TEST(CompliantWedgeTest, FrictionThatCannotHoldTheBodyNeverWedgesAndNoSectionIsEmpty) {
  SceneSource scenes(14);
  size_t most = 0;
  for (int i = 0; i < kScenes / 2; ++i) {
    const Impact impact = Solve(scenes.AnySizes());
    most = std::max(most, impact.sections.size());
    ASSERT_NE(impact.regime, Regime::kWedged) << i;
    ASSERT_EQ(EmptySections(impact), 0) << i;
  }
  std::printf("  %zu sections at most\n", most);
}

TEST(CompliantWedgeTest, EveryPendulumEitherEndsOrIsKnownToBeHeldInAFewSections) {
  SceneSource scenes(11);
  int wedged = 0;
  size_t most = 0;
  for (int i = 0; i < kScenes / 4; ++i) {
    const Problem problem = scenes.RankOne();
    const Impact impact = Solve(problem);
    most = std::max(most, impact.sections.size());
    ASSERT_EQ(impact.w_rank, 1);
    ASSERT_NEAR(impact.u1 * problem.contact.w.nn, impact.v1 * problem.contact.w.tn,
                1e-14 * Speed(problem) * problem.contact.w.nn);
    if (impact.regime != Regime::kWedged) continue;
    ++wedged;
    ASSERT_GE(problem.contact.mu * std::fabs(problem.contact.w.tn), problem.contact.w.nn);
    ASSERT_TRUE(std::isfinite(impact.v1) && std::isfinite(impact.tau1));
    ASSERT_EQ(impact.newton, 0.0);
    ASSERT_EQ(impact.error_estimate, std::numeric_limits<double>::infinity());
    const double sum = impact.work_normal_compression + impact.work_normal_restitution + TangentialWork(impact);
    ASSERT_NEAR(sum, impact.energy_change, 1e-14 * LargestWork(impact));
  }
  std::printf("  %d of %d wedged, %zu sections at most\n", wedged, kScenes / 4, most);
  EXPECT_GT(wedged, kScenes / 80);
  EXPECT_LE(most, 100U);
}

TEST(CompliantWedgeTest, SmallStepsOfTimeHoldTheSameBodiesAndLetTheOthersGo) {
  SceneSource scenes(12);
  int held = 0;
  for (int i = 0; i < 150; ++i) {
    Problem problem = scenes.RankOne();
    problem.contact.mu =
        std::max(problem.contact.mu,
                 1.5 * problem.contact.w.nn / (std::fabs(problem.contact.w.tn) + 0.1 * problem.contact.w.nn));
    problem.contact.coefficient = std::max(problem.contact.coefficient, 0.2);
    const double slowest = 1.0 / std::sqrt(problem.contact.w.nn);
    const double fastest =
        1.0 / std::sqrt(problem.contact.w.tt / problem.ratio_squared +
                        problem.contact.w.nn / (problem.contact.coefficient * problem.contact.coefficient));
    SmallSteps steps(problem, 2e-3 * fastest);
    steps.Run(100.0 * slowest);
    const Impact impact = Solve(problem);
    const bool wedged = impact.regime == Regime::kWedged;
    EXPECT_EQ(wedged, steps.touches()) << i;
    EXPECT_EQ(impact.termination, wedged ? Termination::kRefused : Termination::kConverged) << i;
    held += wedged ? 1 : 0;
  }
  EXPECT_GT(held, 10);
}

TEST(CompliantWedgeTest, ABodyThatLeavesTooLateForTheBudgetIsWedgedToo) {
  const double cosine = std::sqrt(1.0 - 1e-13);
  const Impact impact = Solve(Contact(1.0, cosine, 1.0, -0.3, 1.5, 0.5, 0.8));
  EXPECT_EQ(impact.w_rank, 2);
  EXPECT_EQ(impact.regime, Regime::kWedged);
  EXPECT_EQ(impact.sections.size(), static_cast<size_t>(kMaxSections));
}

TEST(CompliantWedgeTest, TheVelocityThatIsLeftVanishesLikeTheRootOfDetW) {
  const auto left = [](double det) {
    double most = 0.0;
    for (int i = 0; i < 16; ++i) {
      const double cosine = std::sqrt(1.0 - det * std::exp2(-i / 16.0));
      const Impact impact = Solve(Contact(1.0, cosine, 1.0, -cosine, 2.0, 0.9, 0.05));
      EXPECT_NE(impact.regime, Regime::kWedged);
      most = std::max(most, std::hypot(impact.u1, impact.v1));
    }
    return most;
  };
  EXPECT_NEAR(std::log10(left(1e-3) / left(1e-6)) / 3.0, 0.5, 0.05);
}

}  // namespace
}  // namespace ricochet::compliant
