// Audits give back the coefficients of an impact from its velocities, and find the limits that an impossible one
// breaks.

#include "core/audit/audit.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "core/audit/audit_scene.h"
#include "core/audit/coulomb_path.h"
#include "core/engine/row_runs.h"
#include "core/models/restitution_law.h"
#include "tests/support/scenes/known_contacts.h"
#include "tests/support/scenes/spatial_contact.h"

namespace ricochet::audit {
namespace {

using pendulum::Solve;
using planar::Solve;
using spatial::Solve;

constexpr double kUlp = 0x1p-52;

// W = I, v- = (1, -1), mu = 1/2: p = v+ - v- by hand, and compression ends at tau = 1.
const planar::Problem kByHand = {.w = {1.0, 0.0, 1.0}, .u0 = 1.0, .v0 = -1.0, .mu = 0.5, .mu_static = 0.5};

Observation Seen(const planar::Impact& impact, double uncertainty = 0.0) {
  return {{impact.u1}, impact.v1, uncertainty};
}

bool Never() { return false; }

using audit::Audit;
AuditReport Audit(const spatial::Problem& problem, const Observation& observation) {
  return *audit::Audit(problem, observation, Never);
}

// Audits the angular velocity after the impact, of which the uncertainty is in rad/s.
AuditReport AuditRate(const pendulum::Problem& problem, double omega_plus, double uncertainty) {
  const double size = std::hypot(problem.a, problem.b);
  // The component along the range of W moves by the sum of the errors of both components of the velocity.
  const double per_component = uncertainty * size * size / (problem.a + std::abs(problem.b));
  return Audit(problem, {{problem.b * omega_plus}, problem.a * omega_plus, per_component});
}

double CoefficientOf(RestitutionLaw law, const AuditReport& report) {
  if (law == RestitutionLaw::kNewton) return report.newton;
  return law == RestitutionLaw::kPoisson ? report.poisson : report.energetic;
}

// Kane and Levinson's double pendulum: two rods of 1 m and 1 kg, hung up at the first one's start, angles from the
// downward vertical; its tip strikes a horizontal surface. W = J M^-1 J^T.
planar::Problem DoublePendulum(RestitutionLaw law, double coefficient) {
  const double angle1 = std::numbers::pi / 9.0;
  const double angle2 = std::numbers::pi / 6.0;
  const double m11 = 4.0 / 3.0;
  const double m12 = 0.5 * std::cos(angle1 - angle2);
  const double m22 = 1.0 / 3.0;
  const double det = m11 * m22 - m12 * m12;
  const auto w = [&](double a1, double a2, double b1, double b2) {
    return (m22 * a1 * b1 - m12 * (a1 * b2 + a2 * b1) + m11 * a2 * b2) / det;
  };
  const double c1 = std::cos(angle1), c2 = std::cos(angle2), s1 = std::sin(angle1), s2 = std::sin(angle2);
  return {.w = {w(c1, c2, c1, c2), w(c1, c2, s1, s2), w(s1, s2, s1, s2)},
          .u0 = -0.1 * c1 - 0.2 * c2,
          .v0 = -0.1 * s1 - 0.2 * s2,
          .mu = 0.7,
          .mu_static = 0.7,
          .law = law,
          .coefficient = coefficient};
}

// E = (1/2) w^T M w at the rates above.
double DoublePendulumEnergy() {
  return 0.5 * (4.0 / 3.0 * 0.01 + std::cos(std::numbers::pi / 18.0) * 0.02 + 0.04 / 3.0);
}

class RandomContacts {
 public:
  double In(double low, double high) { return std::uniform_real_distribution<double>(low, high)(engine_); }

  planar::Problem Planar() {
    planar::Problem problem;
    problem.w.tt = std::exp(In(-2.0, 2.0));
    problem.w.nn = std::exp(In(-2.0, 2.0));
    problem.w.tn = In(-0.95, 0.95) * std::sqrt(problem.w.tt * problem.w.nn);
    problem.u0 = In(-2.0, 2.0);
    problem.v0 = In(-2.0, -0.1);
    problem.mu = In(0.0, 1.5);
    problem.mu_static = problem.mu * (In(0.0, 1.0) < 0.5 ? 1.0 : In(1.0, 1.5));
    problem.law = static_cast<RestitutionLaw>(std::uniform_int_distribution<int>(0, 2)(engine_));
    problem.coefficient = In(0.05, 1.0);
    return problem;
  }

  // W = A A^T.
  spatial::Problem Spatial() {
    double a[3][3];
    for (auto& row : a) {
      for (double& entry : row) entry = In(-1.0, 1.0);
    }
    const auto w = [&](int i, int j) {
      return a[i][0] * a[j][0] + a[i][1] * a[j][1] + a[i][2] * a[j][2] + (i == j ? 0.2 : 0.0);
    };
    spatial::Problem problem{
        .w11 = w(0, 0), .w12 = w(0, 1), .w13 = w(0, 2), .w22 = w(1, 1), .w23 = w(1, 2), .w33 = w(2, 2)};
    problem.u0 = {In(-2.0, 2.0), In(-2.0, 2.0)};
    problem.v0 = In(-2.0, -0.1);
    problem.mu = problem.mu_static = In(0.05, 1.5);
    problem.law = static_cast<RestitutionLaw>(std::uniform_int_distribution<int>(0, 2)(engine_));
    problem.coefficient = In(0.05, 1.0);
    problem.tolerance = 1e-11;
    return problem;
  }

 private:
  std::mt19937_64 engine_{20090401};
};

std::string Text(const planar::Problem& p) {
  std::string text = "W = [" + std::to_string(p.w.tt) + ", " + std::to_string(p.w.tn) + ", " + std::to_string(p.w.nn);
  text += "], v- = (" + std::to_string(p.u0) + ", " + std::to_string(p.v0) + "), mu = " + std::to_string(p.mu);
  return text + ", law " + std::to_string(static_cast<int>(p.law)) + ", " + std::to_string(p.coefficient);
}

// Bounds how far an ulp of the velocities and of W moves Poisson's coefficient (docs/theory/audit.md).
double Conditioning(const planar::Problem& p, const planar::Impact& impact) {
  const double det = p.w.tt * p.w.nn - p.w.tn * p.w.tn;
  const double terms = std::abs(p.u0) + std::abs(p.v0) + std::abs(impact.u1) + impact.v1 +
                       (p.w.tt + std::abs(p.w.tn)) * std::abs(impact.f1) + (p.w.nn + std::abs(p.w.tn)) * impact.tau1;
  return terms * (p.w.tt + std::abs(p.w.tn)) / det / impact.tau_compression;
}

TEST(AuditTest, WorksTheFortyFiveDegreeRodByHand) {
  // v+ = (0, 1), so p = W^-1 (1, 2) = (-1/8, 7/8), and E+ - E- = p . (v- + v+)/2 = 1/16. The path slips until
  // tau = 4/13, where v = 6/65, and then sticks: it comes to tau = 7/8 at (0, 1) too. tau_c = 20/71.
  const AuditReport report = Audit(FortyFiveDegreeRod(RestitutionLaw::kEnergetic, 0.0), {.u1 = {0.0}, .v1 = 1.0});
  EXPECT_EQ(report.regime, Regime::kStickInRestitution);
  EXPECT_EQ(report.w_rank, 2);
  EXPECT_EQ(report.normal_impulse, 7.0 / 8.0);
  EXPECT_EQ(report.tangential_impulse[0], -1.0 / 8.0);
  EXPECT_EQ(report.energy_change, 1.0 / 16.0);
  EXPECT_EQ(report.newton, 1.0);
  EXPECT_NEAR(report.normal_impulse_compression, 20.0 / 71.0, kUlp);
  EXPECT_NEAR(report.poisson, 337.0 / 160.0, 8 * kUlp);
  const double restitution = 0.5 * (24.0 / 923.0) * (6.0 / 65.0) + 0.5 * (59.0 / 104.0) * (71.0 / 65.0);
  EXPECT_NEAR(report.work_normal_compression, -10.0 / 71.0, kUlp);
  EXPECT_NEAR(report.work_normal_restitution, restitution, 4 * kUlp);
  EXPECT_NEAR(report.energetic, std::sqrt(7.1 * restitution), 8 * kUlp);
  EXPECT_NEAR(report.friction_mismatch[0], 0.0, 4 * kUlp);
  EXPECT_NEAR(report.residual, 0.0, 4 * kUlp);
  EXPECT_TRUE(report.compression_ended);
  EXPECT_FALSE(report.unexplained);
  EXPECT_FALSE(report.admissible);
  EXPECT_EQ(report[AuditLimit::kEnergy].verdict, Verdict::kBroken);
  EXPECT_EQ(report[AuditLimit::kEnergy].excess, 1.0 / 16.0);
  EXPECT_EQ(report[AuditLimit::kSharp].verdict, Verdict::kBroken);
  EXPECT_EQ(report[AuditLimit::kNormalImpulse].verdict, Verdict::kKept);
  EXPECT_EQ(report[AuditLimit::kPenetration].verdict, Verdict::kKept);
  EXPECT_EQ(report[AuditLimit::kCone].verdict, Verdict::kKept);
  EXPECT_NEAR(report[AuditLimit::kCone].excess, 1.0 / 8.0 - 0.7 * 7.0 / 8.0, kUlp);
}

// Counts how often the impacts of a round trip broke a limit.
struct RoundTrip {
  int sharp = 0, energy = 0;
};

void ExpectRoundTrip(const planar::Problem& problem, RoundTrip& seen) {
  const planar::Impact impact = Solve(problem);
  const AuditReport report = Audit(problem, Seen(impact));
  const double close = 16 * kUlp * Conditioning(problem, impact) * (1.0 + impact.poisson);
  SCOPED_TRACE(Text(problem));
  ASSERT_NEAR(report.newton, impact.newton, 16 * kUlp * (1.0 + impact.newton));
  ASSERT_NEAR(report.poisson, impact.poisson, close);
  // The coefficient is a root, so an error of the work of restitution counts by 1/(2 energetic).
  const double energetic_close = close * (impact.energetic + 1.0 / impact.energetic);
  ASSERT_NEAR(report.energetic, impact.energetic, energetic_close);
  ASSERT_NEAR(CoefficientOf(problem.law, report), problem.coefficient, std::max(close, energetic_close));
  ASSERT_NEAR(report.normal_impulse, impact.tau1, report.normal_impulse_uncertainty);
  const double friction =
      report.tangential_impulse_uncertainty[0] + report.normal_impulse_uncertainty * problem.mu_static;
  ASSERT_NEAR(report.friction_mismatch[0], 0.0, friction);
  ASSERT_EQ(report.admissible, !impact.sharp_limit_broken && !impact.energy_limit_broken);
  ASSERT_EQ(report[AuditLimit::kSharp].verdict == Verdict::kBroken, impact.sharp_limit_broken);
  ASSERT_EQ(report[AuditLimit::kEnergy].verdict == Verdict::kBroken, impact.energy_limit_broken);
  ASSERT_EQ(report.regime, impact.regime);
  seen.sharp += impact.sharp_limit_broken ? 1 : 0;
  seen.energy += impact.energy_limit_broken ? 1 : 0;
}

TEST(AuditTest, GivesBackTheCoefficientOfEveryPlanarImpact) {
  RandomContacts random;
  RoundTrip seen;
  for (int i = 0; i < 20000 && !HasFatalFailure(); ++i) ExpectRoundTrip(random.Planar(), seen);
  EXPECT_GT(seen.sharp, 100);
  EXPECT_GT(seen.energy, 10);
}

TEST(AuditTest, GivesBackTheCoefficientAsFarAsANearlySingularWTells) {
  RandomContacts random;
  for (int i = 0; i < 5000 && !HasFatalFailure(); ++i) {
    planar::Problem problem = random.Planar();
    const double missing = std::pow(10.0, random.In(-8.0, -2.0));
    problem.w.tn = std::copysign((1.0 - missing) * std::sqrt(problem.w.tt * problem.w.nn), problem.w.tn);
    const planar::Impact impact = Solve(problem);
    const AuditReport report = Audit(problem, Seen(impact));
    const double close = 16 * kUlp * Conditioning(problem, impact) * (1.0 + impact.poisson);
    SCOPED_TRACE(Text(problem));
    ASSERT_NEAR(report.newton, impact.newton, 16 * kUlp * (1.0 + impact.newton));
    ASSERT_NEAR(report.poisson, impact.poisson, close);
    ASSERT_NEAR(report.normal_impulse, impact.tau1, report.normal_impulse_uncertainty);
    // Rounding alone never makes a limit count as broken.
    ASSERT_TRUE(report.admissible || impact.sharp_limit_broken || impact.energy_limit_broken);
  }
}

TEST(AuditTest, TakesAPerfectReboundAsAdmissible) {
  RandomContacts random;
  for (int i = 0; i < 2000; ++i) {
    planar::Problem problem = random.Planar();
    problem.law = RestitutionLaw::kEnergetic;
    problem.coefficient = 1.0;
    SCOPED_TRACE(Text(problem));
    ASSERT_TRUE(Audit(problem, Seen(Solve(problem))).admissible);
  }
}

TEST(AuditTest, FindsKanesParadoxInData) {
  const planar::Problem problem = DoublePendulum(RestitutionLaw::kNewton, 1.0);
  const AuditReport report = Audit(problem, Seen(Solve(problem)));
  EXPECT_NEAR(report.energy_change / DoublePendulumEnergy(), 5.35, 0.005);
  EXPECT_NEAR(report.newton, 1.0, 4 * kUlp);
  EXPECT_FALSE(report.admissible);
  EXPECT_EQ(report[AuditLimit::kEnergy].verdict, Verdict::kBroken);
  EXPECT_EQ(report[AuditLimit::kEnergy].excess, report.energy_change);
  EXPECT_EQ(report[AuditLimit::kSharp].verdict, Verdict::kBroken);
  EXPECT_GT(report.energetic, 1.0);
  EXPECT_EQ(report[AuditLimit::kCone].verdict, Verdict::kKept);
}

TEST(AuditTest, FindsNoParadoxWhereTheEnergeticLawRebounds) {
  for (const double coefficient : {0.0, 0.5, 0.7, 1.0}) {
    const planar::Problem problem = DoublePendulum(RestitutionLaw::kEnergetic, coefficient);
    const AuditReport report = Audit(problem, Seen(Solve(problem)));
    EXPECT_TRUE(report.admissible) << coefficient;
    EXPECT_NEAR(report.energetic, coefficient, 1e-12);
  }
}

TEST(AuditTest, SeesASpringThatGivesBackMoreThanItStored) {
  // v' = 1.45 in slip and 1.6 in stick, which begins at tau = .8, after compression has ended at 1/1.45.
  planar::Problem problem = FortyFiveDegreeRod(RestitutionLaw::kPoisson, 1.0);
  problem.u0 = 0.2;
  const planar::Impact impact = Solve(problem);
  const AuditReport report = Audit(problem, Seen(impact));
  ASSERT_TRUE(impact.sharp_limit_broken);
  ASSERT_FALSE(impact.energy_limit_broken);
  EXPECT_EQ(report[AuditLimit::kSharp].verdict, Verdict::kBroken);
  EXPECT_NEAR(report[AuditLimit::kSharp].excess, impact.energetic_excess, 1e-12);
  EXPECT_EQ(report[AuditLimit::kEnergy].verdict, Verdict::kKept);
}

TEST(AuditTest, NamesEachLimitAnImpossibleRowBreaks) {
  const AuditReport pulled = Audit(kByHand, {.u1 = {1.0}, .v1 = -1.25});
  EXPECT_EQ(pulled[AuditLimit::kNormalImpulse].verdict, Verdict::kBroken);
  EXPECT_EQ(pulled[AuditLimit::kNormalImpulse].excess, 0.25);
  EXPECT_EQ(pulled[AuditLimit::kPenetration].verdict, Verdict::kBroken);
  EXPECT_EQ(pulled[AuditLimit::kPenetration].excess, 1.25);
  EXPECT_EQ(pulled.poisson, -1.25);
  EXPECT_FALSE(pulled.compression_ended);

  const AuditReport grabbed = Audit(kByHand, {.u1 = {0.0}, .v1 = 0.5});
  EXPECT_EQ(grabbed[AuditLimit::kCone].verdict, Verdict::kBroken);
  EXPECT_EQ(grabbed[AuditLimit::kCone].value, 1.0);
  EXPECT_EQ(grabbed[AuditLimit::kCone].limit, 0.75);
  EXPECT_EQ(grabbed[AuditLimit::kCone].excess, 0.25);
  EXPECT_EQ(grabbed.friction_mismatch[0], -0.25);
  EXPECT_EQ(grabbed.path_tangential_velocity[0], 0.25);
  EXPECT_EQ(grabbed[AuditLimit::kEnergy].verdict, Verdict::kKept);
  EXPECT_FALSE(grabbed.admissible);
}

TEST(AuditTest, RunsThePathToAnImpulseWithinCompression) {
  // The impact is stopped half way: f = -1/4, v = -1/2, the works are -3/8 and -(1/4)(7/8).
  const AuditReport report = Audit(kByHand, {.u1 = {0.75}, .v1 = -0.5});
  EXPECT_FALSE(report.compression_ended);
  EXPECT_EQ(report.regime, Regime::kSliding);
  EXPECT_EQ(report.normal_impulse_compression, 1.0);
  EXPECT_EQ(report.poisson, -0.5);
  EXPECT_EQ(report.newton, -0.5);
  EXPECT_EQ(report.energetic, 0.0);
  EXPECT_EQ(report.work_normal_compression, -0.375);
  EXPECT_EQ(report.work_tangential_compression, -0.21875);
  EXPECT_EQ(report.residual, 0.0);
  EXPECT_EQ(report[AuditLimit::kPenetration].verdict, Verdict::kBroken);
}

TEST(AuditTest, AllowsEachLimitWhatTheUncertaintyMakesOfIt) {
  // W^-1 = [.625, -.375; -.375, .625]: an error d of both velocities moves p_n by d, and the cone's excess by
  // |.625 + .7 .375| + |.375 + .7 .625| where p_t > 0.
  const planar::Problem problem = FortyFiveDegreeRod(RestitutionLaw::kEnergetic, 0.0);
  const double uncertainty = 0x1p-10;
  const AuditReport report = Audit(problem, {.u1 = {1.0}, .v1 = 0.5, .uncertainty = uncertainty});
  ASSERT_GT(report.tangential_impulse[0], 0.0);
  EXPECT_NEAR(report[AuditLimit::kNormalImpulse].allowance, uncertainty, 1e-12);
  EXPECT_NEAR(report[AuditLimit::kPenetration].allowance, uncertainty, 1e-12);
  EXPECT_NEAR(report[AuditLimit::kCone].allowance, uncertainty * (0.8875 + 0.8125), 1e-12);
  EXPECT_NEAR(report[AuditLimit::kEnergy].allowance, uncertainty * (0.4375 + 0.0625), 1e-12);
}

TEST(AuditTest, CallsBrokenOnlyWhatNoVelocityWithinTheUncertaintyKeeps) {
  const planar::Problem problem = FortyFiveDegreeRod(RestitutionLaw::kEnergetic, 1.0);
  const planar::Impact impact = Solve(problem);
  const Observation noisy{{impact.u1}, impact.v1 + 1e-3, 0.0};
  const AuditReport exact = Audit(problem, noisy);
  EXPECT_EQ(exact[AuditLimit::kSharp].verdict, Verdict::kBroken);
  const AuditReport measured = Audit(problem, {noisy.u1, noisy.v1, 1e-3});
  EXPECT_EQ(measured[AuditLimit::kSharp].verdict, Verdict::kWithinUncertainty);
  EXPECT_GT(measured[AuditLimit::kSharp].allowance, measured[AuditLimit::kSharp].excess);
  EXPECT_TRUE(measured.admissible);
  EXPECT_FALSE(Audit(problem, {noisy.u1, noisy.v1, 1e-4}).admissible);
}

TEST(AuditTest, NeverCallsANoisyAdmissibleImpactBroken) {
  RandomContacts random;
  for (int i = 0; i < 5000; ++i) {
    planar::Problem problem = random.Planar();
    problem.law = RestitutionLaw::kEnergetic;
    const planar::Impact impact = Solve(problem);
    const double uncertainty = random.In(0.0, 0.05);
    const Observation seen{{impact.u1 + random.In(-uncertainty, uncertainty)},
                           impact.v1 + random.In(-uncertainty, uncertainty),
                           uncertainty};
    SCOPED_TRACE(Text(problem));
    ASSERT_TRUE(Audit(problem, seen).admissible);
  }
}

TEST(AuditTest, AuditsContactsFarFromTheScaleOfDoublesToo) {
  // The contact is the hand-worked rod in units of 2^-600 m/s and 2^-1020 kg^-1.
  constexpr double kSpeed = 0x1p-600;
  constexpr double kMobility = 0x1p-1020;
  planar::Problem problem = FortyFiveDegreeRod(RestitutionLaw::kEnergetic, 0.0);
  for (double* w : {&problem.w.tt, &problem.w.tn, &problem.w.nn}) *w *= kMobility;
  problem.u0 *= kSpeed;
  problem.v0 *= kSpeed;
  const AuditReport report = Audit(problem, {.u1 = {0.0}, .v1 = kSpeed});
  EXPECT_EQ(report.normal_impulse, 7.0 / 8.0 * (kSpeed / kMobility));
  EXPECT_EQ(report.energy_change, 1.0 / 16.0 * (kSpeed / kMobility) * kSpeed);
  EXPECT_NEAR(report.poisson, 337.0 / 160.0, 8 * kUlp);
  EXPECT_EQ(report[AuditLimit::kEnergy].verdict, Verdict::kBroken);
  EXPECT_EQ(report[AuditLimit::kCone].verdict, Verdict::kKept);
}

TEST(AuditTest, AuditsSpatialContactsWhoseImpulsesHaveNoSquare) {
  // p = (-1, 0, 3/2) in units of 2^-700 N s; mu = 1/2.
  constexpr double kSpeed = 0x1p-300;
  constexpr double kMobility = 0x1p400;
  const spatial::Problem problem =
      spatial::Contact({kMobility, 0.0, 0.0, kMobility, 0.0, kMobility}, {kSpeed, 0.0}, -kSpeed, 0.5);
  const AuditReport report = Audit(problem, {{0.0, 0.0}, 0.5 * kSpeed});
  EXPECT_EQ(report[AuditLimit::kCone].verdict, Verdict::kBroken);
  EXPECT_EQ(report[AuditLimit::kCone].excess, 0.25 * (kSpeed / kMobility));
  EXPECT_EQ(report.friction_mismatch[0], -0.25 * (kSpeed / kMobility));
}

TEST(AuditTest, HoldsAContactThatSticksToTheStaticCone) {
  planar::Problem problem = FortyFiveDegreeRod(RestitutionLaw::kEnergetic, 0.5);
  problem.u0 = 0.0;
  problem.mu = 0.2;
  const planar::Impact impact = Solve(problem);
  ASSERT_GT(std::abs(impact.f1), problem.mu * impact.tau1);
  EXPECT_TRUE(Audit(problem, Seen(impact)).admissible);
}

TEST(AuditTest, ExplainsASeparatingContactOnlyByNoChange) {
  planar::Problem problem = FortyFiveDegreeRod(RestitutionLaw::kEnergetic, 0.5);
  problem.v0 = 0.25;
  const AuditReport same = Audit(problem, {.u1 = {-1.0}, .v1 = 0.25});
  EXPECT_EQ(same.regime, Regime::kSeparating);
  EXPECT_TRUE(same.admissible);
  EXPECT_EQ(same.normal_impulse, 0.0);
  const AuditReport kicked = Audit(problem, {.u1 = {-1.0}, .v1 = 0.5});
  EXPECT_TRUE(kicked.unexplained);
  EXPECT_EQ(kicked.distance, 0.25);
  EXPECT_FALSE(kicked.admissible);
  EXPECT_EQ(kicked[AuditLimit::kEnergy].verdict, Verdict::kBroken);
}

TEST(AuditTest, GivesBackTheCoefficientsOfThePendulum) {
  for (const double b : {-0.4, 0.0, 0.4}) {
    for (const RestitutionLaw law : {RestitutionLaw::kNewton, RestitutionLaw::kPoisson, RestitutionLaw::kEnergetic}) {
      for (const double coefficient : {0.0, 0.3, 0.6}) {
        const pendulum::Problem problem{.inertia = 0.7,
                                        .a = 1.3,
                                        .b = b,
                                        .omega_minus = -2.1,
                                        .mu = 0.6,
                                        .mu_static = 0.6,
                                        .law = law,
                                        .coefficient = coefficient};
        const pendulum::Impact impact = Solve(problem);
        using pendulum::Output;
        const AuditReport report = AuditRate(problem, impact[Output::kOmegaPlus], 0.0);
        EXPECT_NEAR(report.newton, impact[Output::kNewton], 4 * kUlp);
        EXPECT_NEAR(report.poisson, impact[Output::kPoisson], 4 * kUlp);
        EXPECT_NEAR(report.energetic, impact[Output::kEnergetic], 4 * kUlp);
        EXPECT_NEAR(report.energy_change, impact[Output::kEnergyChange], 8 * kUlp);
        EXPECT_NEAR(report.normal_impulse, impact[Output::kNormalImpulse], 8 * kUlp);
        EXPECT_EQ(report.regime, impact.regime);
        EXPECT_TRUE(report.admissible);
        EXPECT_EQ(report.w_rank, 1);
      }
    }
  }
}

// tau1 is a few times the least double, and mu times half of that is large enough to leave the cone.
TEST(AuditTest, ASubnormalNormalImpulseBreaksNoCone) {
  const pendulum::Problem problem = {.inertia = 0.1308892775068743,
                                     .a = 0.3,
                                     .b = 4294967296.0,
                                     .omega_minus = -1.0,
                                     .mu = 1.348269851146737e+307,
                                     .mu_static = 1.348269851146737e+307};
  EXPECT_TRUE(AuditRate(problem, 0.0, 0.0).admissible);
}

TEST(AuditTest, FlagsAPendulumAboveItsSharpBound) {
  // x = 1/3, r = 1/2: Newton's coefficient is at most sqrt(1/2) = .7071.
  const pendulum::Problem problem{.inertia = 1.0, .a = 0.3, .b = 1.0, .omega_minus = -1.0, .mu = 0.1, .mu_static = 0.1};
  EXPECT_TRUE(AuditRate(problem, 0.707, 0.0).admissible);
  const AuditReport above = AuditRate(problem, 0.72, 0.0);
  EXPECT_EQ(above[AuditLimit::kSharp].verdict, Verdict::kBroken);
  EXPECT_EQ(above[AuditLimit::kEnergy].verdict, Verdict::kKept);
  EXPECT_NEAR(above.energetic, 0.72 * std::numbers::sqrt2, 1e-15);
  EXPECT_TRUE(AuditRate(problem, 0.72, 0.013).admissible);
  EXPECT_FALSE(AuditRate(problem, 0.72, 0.0128).admissible);
  EXPECT_EQ(AuditRate(problem, 1.01, 0.0)[AuditLimit::kEnergy].verdict, Verdict::kBroken);
}

// W = [4, 2; 2, 1], v- = -(2, 1), mu = 1/4: x = 1/2, tau_c = 2/3.
planar::Problem RankOneContact(double mu) {
  return {.w = {4.0, 2.0, 1.0}, .u0 = -2.0, .v0 = -1.0, .mu = mu, .mu_static = mu};
}

TEST(AuditTest, TakesTheRankOnePathToTheObservedVelocity) {
  const AuditReport report = Audit(RankOneContact(0.25), {.u1 = {0.5}, .v1 = 0.25});
  EXPECT_EQ(report.w_rank, 1);
  EXPECT_FALSE(report.unexplained);
  EXPECT_TRUE(report.admissible);
  EXPECT_EQ(report.newton, 0.25);
  // v' is 3/2 in compression and 1/2 in restitution.
  EXPECT_NEAR(report.normal_impulse, 2.0 / 3.0 + 0.5, 2 * kUlp);
  EXPECT_NEAR(report.tangential_impulse[0], 0.25 * (2.0 / 3.0 - 0.5), 2 * kUlp);
  EXPECT_NEAR(report.poisson, 0.75, 4 * kUlp);
  EXPECT_NEAR(report.energetic, 0.25 * std::sqrt(3.0), 4 * kUlp);
  EXPECT_NEAR(report.residual, 0.0, 4 * kUlp);

  const AuditReport compressing = Audit(RankOneContact(0.25), {.u1 = {-1.0}, .v1 = -0.5});
  EXPECT_FALSE(compressing.unexplained);
  EXPECT_NEAR(compressing.normal_impulse, 1.0 / 3.0, 2 * kUlp);
  EXPECT_EQ(compressing[AuditLimit::kPenetration].verdict, Verdict::kBroken);
}

TEST(AuditTest, NamesTheNearestPointWhereRankOneCannotHaveMovedSo) {
  // (0, 1) lies 2/sqrt 5 beside the line of (2, 1), and nearest to (.4, .2).
  const AuditReport off = Audit(RankOneContact(0.25), {.u1 = {0.0}, .v1 = 1.0});
  EXPECT_TRUE(off.unexplained);
  EXPECT_FALSE(off.admissible);
  EXPECT_NEAR(off.distance, 2.0 / std::sqrt(5.0), 4 * kUlp);
  EXPECT_NEAR(off.path_normal_velocity, 0.2, 2 * kUlp);
  EXPECT_NEAR(off.newton, 0.2, 2 * kUlp);
  EXPECT_FALSE(Audit(RankOneContact(0.25), {.u1 = {0.0}, .v1 = 1.0, .uncertainty = 0.7}).unexplained);

  // A friction of mu = 1/2 locks the contact, so that any rebound is unexplained.
  const AuditReport held = Audit(RankOneContact(0.5), {.u1 = {0.0}, .v1 = 0.0});
  EXPECT_TRUE(held.admissible);
  EXPECT_EQ(held.regime, Regime::kLocked);
  const AuditReport rebound = Audit(RankOneContact(0.5), {.u1 = {0.2}, .v1 = 0.1});
  EXPECT_TRUE(rebound.unexplained);
  EXPECT_NEAR(rebound.distance, std::hypot(0.2, 0.1), kUlp);
  EXPECT_FALSE(Audit(RankOneContact(0.5), {.u1 = {0.2}, .v1 = 0.1, .uncertainty = 0.2}).unexplained);

  // The velocity cannot have gone backwards either.
  const AuditReport backwards = Audit(RankOneContact(0.25), {.u1 = {-4.0}, .v1 = -2.0});
  EXPECT_TRUE(backwards.unexplained);
  EXPECT_EQ(backwards.normal_impulse, 0.0);
  EXPECT_NEAR(backwards.distance, std::sqrt(5.0), 4 * kUlp);
}

TEST(AuditTest, GivesBackTheCoefficientOfEverySpatialImpact) {
  RandomContacts random;
  for (int i = 0; i < 1000; ++i) {
    const spatial::Problem problem = random.Spatial();
    const spatial::Impact impact = Solve(problem);
    const double scale = std::max(std::hypot(problem.u0[0], problem.u0[1]), -problem.v0);
    const AuditReport report = Audit(problem, {impact.u1, impact.v1, problem.tolerance * scale});
    SCOPED_TRACE(i);
    const double close = 4.0 * report.normal_impulse_uncertainty / impact.tau_compression + 100.0 * problem.tolerance;
    ASSERT_NEAR(report.newton, impact.newton, 2.0 * problem.tolerance * scale / -problem.v0);
    ASSERT_NEAR(report.poisson, impact.poisson, close);
    ASSERT_NEAR(report.energetic, impact.energetic, close * (1.0 + impact.energetic + 1.0 / impact.energetic));
    ASSERT_NEAR(report.friction_mismatch[0], 0.0,
                4.0 * (report.tangential_impulse_uncertainty[0] + report.normal_impulse_uncertainty * problem.mu));
    ASSERT_NEAR(report.friction_mismatch[1], 0.0,
                4.0 * (report.tangential_impulse_uncertainty[1] + report.normal_impulse_uncertainty * problem.mu));
    ASSERT_EQ(report.admissible, !impact.sharp_limit_broken && !impact.energy_limit_broken);
    ASSERT_EQ(report.w_rank, 3);
  }
}

TEST(AuditTest, SeesTheSameInSpaceWhereWDecouples) {
  RandomContacts random;
  for (int i = 0; i < 200; ++i) {
    const planar::Problem plane = random.Planar();
    const spatial::Problem space{.w11 = plane.w.tt,
                                 .w13 = plane.w.tn,
                                 .w22 = plane.w.tt,
                                 .w33 = plane.w.nn,
                                 .u0 = {plane.u0, 0.0},
                                 .v0 = plane.v0,
                                 .mu = plane.mu,
                                 .mu_static = plane.mu_static};
    const double u1 = random.In(-1.0, 1.0);
    const double v1 = random.In(-0.5, 1.0);
    const AuditReport in_plane = Audit(plane, {{u1}, v1});
    const AuditReport in_space = Audit(space, {{u1, 0.0}, v1});
    SCOPED_TRACE(Text(plane));
    const double scale = std::abs(plane.u0) - plane.v0 + 1.0;
    ASSERT_NEAR(in_space.normal_impulse, in_plane.normal_impulse, 1e-12 * (1.0 + std::abs(in_plane.normal_impulse)));
    ASSERT_NEAR(in_space.energy_change, in_plane.energy_change, 1e-12 * (1.0 + std::abs(in_plane.energy_change)));
    ASSERT_NEAR(in_space.poisson, in_plane.poisson, 1e-9 * (1.0 + std::abs(in_plane.poisson)));
    ASSERT_NEAR(in_space.path_tangential_velocity[0], in_plane.path_tangential_velocity[0], 1e-8 * scale);
    ASSERT_NEAR(in_space.path_normal_velocity, in_plane.path_normal_velocity, 1e-8 * scale);
    ASSERT_NEAR(in_space.work_normal_compression, in_plane.work_normal_compression,
                1e-8 * (1.0 + std::abs(in_plane.work_normal_compression)));
    ASSERT_NEAR(in_space.work_tangential_compression, in_plane.work_tangential_compression,
                1e-8 * (1.0 + std::abs(in_plane.work_tangential_compression)));
    ASSERT_EQ(in_space.admissible, in_plane.admissible);
  }
}

// The works of a slip that turns before compression ends are compared with the trapezoids of a fine path.
TEST(AuditTest, RunsASpatialPathToAnImpulseWithinCompression) {
  spatial::Problem problem = TurningContact(1.0, 0.6, 0.4);
  problem.tolerance = 1e-11;
  const double tau = 0.6 * PathAt(problem, 0.0).tau_compression;
  const PathPoint point = PathAt(problem, tau);
  double normal = 0.0;
  double tangential = 0.0;
  PathPoint from = PathAt(problem, 0.0);
  constexpr int kPieces = 2000;
  for (int i = 1; i <= kPieces; ++i) {
    const PathPoint to = PathAt(problem, tau * i / kPieces);
    normal += 0.5 * (to.tau - from.tau) * (from.v + to.v);
    for (size_t t = 0; t < 2; ++t) tangential += 0.5 * (to.f[t] - from.f[t]) * (from.u[t] + to.u[t]);
    from = to;
  }
  EXPECT_NEAR(point.u[0], 1.0 + 1.96 * point.f[0] + 0.24 * point.f[1] + 0.6 * tau, 1e-10);
  EXPECT_NEAR(point.u[1], 0.6 + 0.24 * point.f[0] + 2.96 * point.f[1] - 0.8 * tau, 1e-10);
  EXPECT_NEAR(point.v, -1.0 + 0.6 * point.f[0] - 0.8 * point.f[1] + 1.85 * tau, 1e-10);
  EXPECT_NEAR(point.work_normal_compression, normal, 1e-7);
  EXPECT_NEAR(point.work_tangential_compression, tangential, 1e-7);
  EXPECT_NEAR(point.work_normal_compression + point.work_tangential_compression, point.energy_change, 1e-10);
  EXPECT_LT(point.v, 0.0);
}

TEST(AuditTest, SearchesTheNearestPointOfARankDeficientSpatialPath) {
  // Nothing moves along t2: W = [2, 0, 1; 0, 0, 0; 1, 0, 3], a plane's contact but for the third row.
  const spatial::Problem problem = spatial::Contact({2.0, 0.0, 1.0, 0.0, 0.0, 3.0}, {1.0, 0.0}, -1.0, 0.3,
                                                    {.law = RestitutionLaw::kEnergetic, .coefficient = 0.6});
  const spatial::Impact impact = Solve(problem);
  ASSERT_EQ(impact.w_rank, 2);
  const AuditReport explained = Audit(problem, {impact.u1, impact.v1, 1e-9});
  EXPECT_FALSE(explained.unexplained);
  EXPECT_TRUE(explained.admissible);
  EXPECT_NEAR(explained.energetic, 0.6, 1e-7);
  const AuditReport beside = Audit(problem, {{impact.u1[0], 0.25}, impact.v1, 1e-9});
  EXPECT_TRUE(beside.unexplained);
  EXPECT_NEAR(beside.distance, 0.25, 1e-9);
  EXPECT_NEAR(beside.energetic, 0.6, 1e-4);
}

// Returns the scene of a contact, without the restitution that an audit does not need.
Scene SceneOf(const planar::Problem& contact) {
  return {.system = PlanarContact{contact.w.tt, contact.w.tn, contact.w.nn, contact.u0, contact.v0},
          .friction = {.kinetic_coefficient = contact.mu, .static_coefficient = contact.mu_static}};
}

Scene SceneOf(const spatial::Problem& contact) {
  return {.system = SpatialContact{{contact.w11, contact.w12, contact.w13, contact.w22, contact.w23, contact.w33},
                                   {contact.u0[0], contact.u0[1]},
                                   contact.v0},
          .friction = {.kinetic_coefficient = contact.mu, .static_coefficient = contact.mu_static}};
}

TEST(AuditBatchTest, CountsTheLimitsThatRowsBreakAndWhereFirst) {
  // The rows are: admissible, pulled, admissible, grabbed, NaN, energetic coefficients of 1.5 and of 1.05 +- .1.
  const AuditColumns columns = {.tangential_after_m_s = {0.25, 1.0, 0.5, 0.0, std::nan(""), 0.0, 0.0},
                                .normal_after_m_s = {0.5, -1.25, 0.0, 0.5, 0.0, 1.5, 1.05},
                                .velocity_uncertainty_m_s = {0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.1}};
  const auto response = RunAudits(AuditBatchRequest{.scene = SceneOf(kByHand), .columns = columns}, nullptr, Never);
  ASSERT_TRUE(response.ok()) << response.status();
  const std::vector<AuditReport>& reports = response->reports;
  const AuditSummary& summary = response->summary;
  ASSERT_EQ(reports.size(), 7U);
  EXPECT_EQ(summary.rows, 7);
  EXPECT_EQ(summary.admissible, 3);
  EXPECT_EQ(summary.invalid, (Tally{1, 4}));
  EXPECT_EQ(reports[4].regime, Regime::kInvalid);
  EXPECT_EQ(summary.unexplained, (Tally{0, -1}));
  const auto broken = [&](AuditLimit limit) { return summary.broken[static_cast<size_t>(limit)]; };
  EXPECT_EQ(broken(AuditLimit::kNormalImpulse), (Tally{1, 1}));
  EXPECT_EQ(broken(AuditLimit::kPenetration), (Tally{1, 1}));
  EXPECT_EQ(broken(AuditLimit::kCone), (Tally{2, 1}));
  EXPECT_EQ(broken(AuditLimit::kSharp), (Tally{1, 5}));
  EXPECT_EQ(broken(AuditLimit::kEnergy), (Tally{2, 1}));
  EXPECT_EQ(summary.within_uncertainty[static_cast<size_t>(AuditLimit::kSharp)], (Tally{1, 6}));
  EXPECT_EQ(summary.largest_excess[static_cast<size_t>(AuditLimit::kSharp)], 0.5);
  EXPECT_EQ(reports[3], Audit(kByHand, {.u1 = {0.0}, .v1 = 0.5}));
}

TEST(AuditBatchTest, NamesTheColumnWhoseLengthIsWrong) {
  const AuditColumns columns = {
      .tangential_after_m_s = {1.0, 1.0, 1.0}, .normal_after_m_s = {-1.0}, .friction = {0.5, 0.5}};
  const auto response = RunAudits(AuditBatchRequest{.scene = SceneOf(kByHand), .columns = columns}, nullptr, Never);
  EXPECT_EQ(response.status().code(), absl::StatusCode::kInvalidArgument);
  const std::string message(response.status().message());
  EXPECT_NE(message.find("columns.friction has 2 values: must have 1 or 3"), std::string::npos) << message;
}

TEST(AuditBatchTest, MarksRowsThatTheContactCannotHave) {
  // The rows have a friction below 0 or not finite, a negative uncertainty, no velocity; the last one is good.
  const double nan = std::nan("");
  const AuditColumns columns = {.tangential_m_s = {1.0, 1.0, 1.0, nan, 1.0},
                                .normal_m_s = {-1.0},
                                .tangential_after_m_s = {1.0},
                                .normal_after_m_s = {0.0},
                                .friction = {-0.1, nan, 0.5, 0.5, 0.5},
                                .velocity_uncertainty_m_s = {0.0, 0.0, -1.0, 0.0, 0.0}};
  const auto response = RunAudits(AuditBatchRequest{.scene = SceneOf(kByHand), .columns = columns}, nullptr, Never);
  ASSERT_TRUE(response.ok()) << response.status();
  EXPECT_EQ(response->summary.invalid, (Tally{4, 0}));
  EXPECT_NE(response->reports[4].regime, Regime::kInvalid);

  // The velocities of a contact of rank one are multiples of (2, 1).
  const AuditColumns along = {.tangential_m_s = {-2.0, -1.0, -4.0},
                              .normal_m_s = {-1.0, -1.0, -2.0},
                              .tangential_after_m_s = {0.0},
                              .normal_after_m_s = {0.0}};
  const auto rank_one =
      RunAudits(AuditBatchRequest{.scene = SceneOf(RankOneContact(0.25)), .columns = along}, nullptr, Never);
  ASSERT_TRUE(rank_one.ok()) << rank_one.status();
  EXPECT_EQ(rank_one->summary.invalid, (Tally{1, 1}));
}

TEST(AuditBatchTest, SinglesOutTheRowThatOverflows) {
  // p_n = (v+ - v-)/Wnn: 1e308/1e-3 exceeds the largest double.
  planar::Problem contact = kByHand;
  contact.w.nn = 1e-3;
  const AuditColumns columns = {.tangential_after_m_s = {contact.u0}, .normal_after_m_s = {0.5, 1e308, 0.25}};
  const auto response = RunAudits(AuditBatchRequest{.scene = SceneOf(contact), .columns = columns}, nullptr, Never);
  ASSERT_TRUE(response.ok()) << response.status();
  EXPECT_EQ(response->summary.rows, 3);
  EXPECT_EQ(response->summary.invalid, (Tally{1, 1}));
  EXPECT_EQ(response->reports[1], AuditReport{.regime = Regime::kInvalid});
  EXPECT_EQ(response->reports[2], Audit(contact, {.u1 = {contact.u0}, .v1 = 0.25}));
  EXPECT_STREQ(OverflowIn(Audit(contact, {.u1 = {contact.u0}, .v1 = 1e308})), "report.normal_impulse_n_s");
  EXPECT_EQ(OverflowIn(response->reports[2]), nullptr);
}

TEST(AuditBatchTest, AuditsSpatialRowsAsItAuditsOne) {
  const Scene scene = SceneOf(TurningContact(1.0, 0.6, 0.4));
  const std::vector<double> v1 = {0.5, 1.0};
  const AuditColumns columns = {
      .tangential_after_m_s = {0.8}, .tangential_2_after_m_s = {-0.3}, .normal_after_m_s = v1};
  const auto response = RunAudits(AuditBatchRequest{.scene = scene, .columns = columns}, nullptr, Never);
  ASSERT_TRUE(response.ok()) << response.status();
  ASSERT_EQ(response->reports.size(), 2U);
  for (size_t row = 0; row < 2; ++row) {
    const ContactVelocity seen = {.tangential_m_s = {0.8, -0.3}, .normal_m_s = v1[row]};
    const auto one = AuditScene(AuditRequest{.scene = scene, .observed = seen}, Never);
    ASSERT_TRUE(one.ok()) << one.status();
    EXPECT_EQ(response->reports[row], one->report);
  }
  EXPECT_EQ(response->summary.invalid.count, 0);
}

// ---- Stops ----

// W moves the contact along (1, 0, 1) alone, as an arm on a hinge would: no other velocity can come before an impact.
TEST(AuditBatchTest, MarksSpatialRowsOutsideTheRangeOfASingularW) {
  Scene scene = {.system = SpatialContact{{1.0, 0.0, 1.0, 0.0, 0.0, 1.0}, {-1.0, 0.0}, -1.0},
                 .friction = {.kinetic_coefficient = 0.2}};
  const AuditColumns columns = {.tangential_m_s = {-1.0, 1.0, -1.0, 1.0},
                                .tangential_2_m_s = {0.0, 0.0, 0.1, 0.0},
                                .normal_m_s = {-1.0, -1.0, -1.0, 1.0},
                                .tangential_after_m_s = {0.0, 0.0, 0.0, 1.0},
                                .tangential_2_after_m_s = {0.0},
                                .normal_after_m_s = {0.0, 0.0, 0.0, 1.0}};
  const auto response = RunAudits(AuditBatchRequest{.scene = scene, .columns = columns}, nullptr, Never);
  ASSERT_TRUE(response.ok()) << response.status();
  EXPECT_NE(response->reports[0].regime, Regime::kInvalid);
  EXPECT_EQ(response->reports[1].regime, Regime::kInvalid);
  EXPECT_EQ(response->reports[2].regime, Regime::kInvalid);
  EXPECT_NE(response->reports[3].regime, Regime::kInvalid);  // It separates.
  EXPECT_EQ(response->summary.invalid.count, 2);
}

TEST(AuditStopTest, ABatchLooksBeforeEachRow) {
  const AuditColumns columns = {.tangential_after_m_s = {0.25}, .normal_after_m_s = {0.5, 0.5, 0.5, 0.5, 0.5}};
  int looks = 0;
  const auto response = RunAudits(AuditBatchRequest{.scene = SceneOf(kByHand), .columns = columns}, nullptr,
                                  [&looks] { return ++looks == 4; });
  EXPECT_EQ(response.status().code(), absl::StatusCode::kCancelled);
  EXPECT_EQ(looks, 4);
}

// No impulse moves the contact along the second direction, so the nearest point of its path is searched for.
absl::StatusOr<AuditResponse> AuditOf(const Scene& scene, const ContactVelocity& seen, double uncertainty) {
  return AuditScene({.scene = scene, .observed = seen, .velocity_uncertainty_m_s = uncertainty}, Never);
}

Scene InSpace(const std::vector<double>& w, const std::vector<double>& tangential, double normal, double mu) {
  return {.system = SpatialContact{.w_per_kg = w, .tangential_m_s = tangential, .normal_m_s = normal},
          .friction = {.kinetic_coefficient = mu},
          .restitution = EnergeticCoefficient{1.0}};
}

// The path passes the observed velocity at tau = 0.34, and goes on to 200 times that before its normal velocity tells
// that it comes no nearer. The velocity is that of du/dtau = W (-mu u/|u|, 1) by a Runge-Kutta method of order 8.
TEST(AuditDeficientTest, AnEarlyPointOfALongPathIsFound) {
  const Scene scene = InSpace({2.0, -5.0, -1.0, 17.0, 4.0, 1.0}, {3.0, -6.0}, -1.0, 0.5);
  const auto audit = AuditOf(scene, {{1.765917535881787, -1.7659175358817871}, 0.0}, 1e-3);
  ASSERT_TRUE(audit.ok());
  EXPECT_FALSE(audit->report.unexplained);
  EXPECT_TRUE(audit->report.admissible);
}

TEST(AuditDeficientTest, OutcomesOfTheEngineAreExplained) {
  const Scene scene = InSpace({20.0, 2.0, -8.0, 13.0, -20.0, 32.0}, {-4.0, 6.0}, -8.0, 0.1);
  const auto audit = AuditOf(scene, {{-7.120838497144656, -3.969649072176089}, 7.734683232550296}, 0.0);
  ASSERT_TRUE(audit.ok());
  EXPECT_FALSE(audit->report.unexplained);
}

// An elastic impact along (1, 1, 1), each component of which is observed 0.0099 m/s too large.
TEST(AuditDeficientTest, AnErrorOfEachComponentIsNoBrokenLimit) {
  const Scene scene = InSpace({1.0, 1.0, 1.0, 1.0, 1.0, 1.0}, {-1.0, -1.0}, -1.0, 0.1);
  const ContactVelocity after = LocalSolver().Solve({.scene = scene})->outcome.contact_velocity_after;
  const ContactVelocity seen = {{after.tangential_m_s[0] + 0.0099, after.tangential_m_s[1] + 0.0099},
                                after.normal_m_s + 0.0099};
  EXPECT_EQ(AuditOf(scene, seen, 0.01)->report[AuditLimit::kSharp].verdict, Verdict::kWithinUncertainty);
  EXPECT_EQ(AuditOf(scene, seen, 0.005)->report[AuditLimit::kSharp].verdict, Verdict::kBroken);
}

TEST(AuditDeficientTest, AContactThatSeparatesBesideTheRangeKeepsItsVelocity) {
  const Scene scene = {.system = PlanarContact{1.0, 1.0, 1.0, 2.5, 0.3}, .friction = {.kinetic_coefficient = 0.1}};
  EXPECT_FALSE(AuditOf(scene, {{2.5}, 0.3}, 0.0)->report.unexplained);
  EXPECT_TRUE(AuditOf(scene, {{2.6}, 0.3}, 0.01)->report.unexplained);
}

// Tangential compliance lets an impact keep more than the energetic coefficient of a rigid contact, and forces add
// energy.
TEST(AuditSceneTest, ContactsThatAreNotRigidAreRefused) {
  Scene scene = {.system = PlanarContact{2.0, 1.0, 1.0, -2.0, -1.0},
                 .friction = {.kinetic_coefficient = 2.0},
                 .restitution = EnergeticCoefficient{1.0},
                 .compliance = Compliance{.tangential_ratio_squared = 4.0}};
  const auto fields = [](const absl::Status& status) {
    std::vector<std::string> names;
    for (const Violation& violation : ViolationsOf(status)) names.push_back(violation.field);
    return names;
  };
  const ContactVelocity seen = {{1.0}, 1.0};
  const std::vector<std::string> compliance = {"compliance.tangential_ratio_squared"};
  EXPECT_EQ(fields(AuditOf(scene, seen, 0.0).status()), compliance);
  EXPECT_EQ(fields(LocalSolver().Bounds({.scene = scene}).status()), compliance);
  scene.compliance = Compliance{.normal = LinearSpring{100.0}};
  EXPECT_TRUE(AuditOf(scene, seen, 0.0).ok());
  EXPECT_TRUE(LocalSolver().Bounds({.scene = scene}).ok());
  scene.finite_forces = ContactAcceleration{.tangential_m_s2 = 10.0};
  const std::vector<std::string> forces = {"finite_forces"};
  EXPECT_EQ(fields(AuditOf(scene, seen, 0.0).status()), forces);
  EXPECT_EQ(fields(LocalSolver().Bounds({.scene = scene}).status()), forces);
}

// Friction of 10^80 takes more steps than an impact has. Where W is singular, a search takes an impact for each point,
// and at 10^40 more steps than all of them have.
TEST(AuditTest, APathThatTakesTooManyStepsIsNoVerdict) {
  const Scene wedge = {
      .system = SpatialContact{.w_per_kg = {2, 0.3, 0.5, 3, -0.4, 1.5}, .tangential_m_s = {1, 0.5}, .normal_m_s = -1},
      .friction = {.kinetic_coefficient = 1e80}};
  const Scene arm = {.system = Mechanism{.mass_matrix = {1.25, -1.25, -1.25, 1.9},
                                         .jacobian = {-0.21148149232585067, -1.3385885695120145, 0.3790582835263828,
                                                      -0.9068520388342067, 2.142752790918834, 0.4277250075941914},
                                         .rates = {-2.0328627547563, -0.28224518188067366}},
                     .friction = {.kinetic_coefficient = 1e40}};
  for (const Scene& scene : {wedge, arm}) {
    const absl::Status one = AuditOf(scene, {{0.1, 0.1}, 1.3}, 0.0).status();
    EXPECT_EQ(one.code(), absl::StatusCode::kOutOfRange) << one;
    EXPECT_EQ(ReasonOf(one), ErrorReason::kNotEnded);
    const auto batch = LocalSolver().AuditBatch(
        {.scene = scene,
         .columns = {.tangential_after_m_s = {0.1}, .tangential_2_after_m_s = {0.1}, .normal_after_m_s = {1.3}}});
    ASSERT_TRUE(batch.ok()) << batch.status();
    EXPECT_EQ(batch->summary.invalid, (Tally{1, 0}));
  }
}

TEST(AuditStopTest, TheSearchOfARankDeficientSpatialPathEndsAtItsNextStep) {
  const spatial::Problem problem = spatial::Contact({2.0, 0.0, 1.0, 0.0, 0.0, 3.0}, {1.0, 0.0}, -1.0, 0.3);
  int64_t all = 0;
  const auto count = [&all] {
    ++all;
    return false;
  };
  ASSERT_TRUE(audit::Audit(problem, {{0.5, 0.0}, 0.5}, count).ok());
  EXPECT_GT(all, 100);
  // The stops fall into the equal steps, into the golden section, and on the last look.
  for (const int64_t stop : {int64_t{1}, int64_t{40}, int64_t{70}, all}) {
    int64_t looks = 0;
    const auto stopped = audit::Audit(problem, {{0.5, 0.0}, 0.5}, [&] { return ++looks == stop; });
    EXPECT_EQ(stopped.status().code(), absl::StatusCode::kCancelled);
    EXPECT_EQ(looks, stop);
  }
  const AuditRequest request = {.scene = SceneOf(problem),
                                .observed = ContactVelocity{.tangential_m_s = {0.5, 0.0}, .normal_m_s = 0.5}};
  EXPECT_EQ(AuditScene(request, [] { return true; }).status().code(), absl::StatusCode::kCancelled);
}

}  // namespace
}  // namespace ricochet::audit
