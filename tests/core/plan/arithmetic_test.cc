// The arithmetic that a tolerance calls for, and what its bound promises.

#include "core/plan/arithmetic.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <limits>
#include <random>

#include "tests/support/scenes/pendulum_scenes.h"
#include "tests/support/scenes/planar_scenes.h"

namespace ricochet {
namespace {

// A pendulum and a contact far from every threshold.
constexpr pendulum::Problem kPendulum = {
    .inertia = 1.0, .a = 0.3, .b = 1.0, .omega_minus = -2.0, .mu = 0.1, .mu_static = 0.1, .coefficient = 0.5};
constexpr planar::Problem kContact = {
    .w = {2.5, -1.5, 2.5}, .u0 = 1.0, .v0 = -1.0, .mu = 0.1, .mu_static = 0.1, .coefficient = 0.5};

template <typename Problem>
class ArithmeticTest : public testing::Test {};
using Problems = testing::Types<pendulum::Problem, planar::Problem>;
TYPED_TEST_SUITE(ArithmeticTest, Problems);

template <typename Problem>
const Problem& Easy();
template <>
const pendulum::Problem& Easy() {
  return kPendulum;
}
template <>
const planar::Problem& Easy() {
  return kContact;
}

// The velocity along n after the impact.
double Rebound(const pendulum::Impact& impact) { return impact[pendulum::Output::kNormalVelocityAfter]; }
double Rebound(const planar::Impact& impact) { return impact.v1; }

double CompensatedRebound(const pendulum::Problem& problem) { return Rebound(pendulum::Solve(problem)); }
double CompensatedRebound(const planar::Problem& problem) { return Rebound(planar::Solve(problem)); }
double PlainRebound(const pendulum::Problem& problem) { return Rebound(pendulum::SolvePlain(problem).impact); }
double PlainRebound(const planar::Problem& problem) { return Rebound(planar::SolvePlain(problem).impact); }

TYPED_TEST(ArithmeticTest, ToleranceOfZeroTakesCompensatedArithmetic) {
  const auto solved = SolveWithin(Easy<TypeParam>(), 0.0);
  EXPECT_EQ(solved.arithmetic.arithmetic, Arithmetic::kCompensated);
  EXPECT_EQ(Rebound(solved.impact), CompensatedRebound(Easy<TypeParam>()));
  EXPECT_GT(solved.relative_error(), 0.0);
  EXPECT_LE(solved.relative_error(), 0x1p-49);
}

TYPED_TEST(ArithmeticTest, PlainArithmeticServesFromItsBoundOn) {
  const auto plain = SolveWithin(Easy<TypeParam>(), 1e-12);
  EXPECT_EQ(plain.arithmetic.arithmetic, Arithmetic::kPlain);
  EXPECT_EQ(Rebound(plain.impact), PlainRebound(Easy<TypeParam>()));
  EXPECT_LE(plain.relative_error(), 1e-12);
  const auto just = SolveWithin(Easy<TypeParam>(), plain.relative_error());
  EXPECT_EQ(just.arithmetic.arithmetic, Arithmetic::kPlain);
  EXPECT_EQ(just.relative_error(), plain.relative_error());
  const auto below = SolveWithin(Easy<TypeParam>(), std::nextafter(plain.relative_error(), 0.0));
  EXPECT_EQ(below.arithmetic.arithmetic, Arithmetic::kCompensated);
  EXPECT_LT(below.relative_error(), plain.relative_error());
}

TEST(SolveWithinTest, SignThatPlainArithmeticCannotProveIsDecidedByCompensatedArithmetic) {
  // Newton's coefficient is the sharp limit, sqrt(r): x = 1/3, r = 1/2.
  pendulum::Problem on_the_limit = kPendulum;
  on_the_limit.law = RestitutionLaw::kNewton;
  on_the_limit.coefficient = std::sqrt(0.5);
  EXPECT_EQ(SolveWithin(on_the_limit, 0.1).arithmetic.arithmetic, Arithmetic::kCompensated);

  // Slip stops at the end of compression.
  planar::Problem at_the_end = kContact;
  at_the_end.w = {2.0, 0.0, 2.0};
  at_the_end.mu = at_the_end.mu_static = 1.0;
  EXPECT_EQ(SolveWithin(at_the_end, 0.1).arithmetic.arithmetic, Arithmetic::kCompensated);
}

// One pendulum for each reason; x = 1/3 and kappa_hat on the sharp limit as above.
TEST(SolveWithinTest, GivesTheReasonForItsArithmetic) {
  EXPECT_EQ(SolveWithin(kPendulum, 1e-12).arithmetic.reason, ArithmeticReason::kWithinTolerance);
  EXPECT_EQ(SolveWithin(kPendulum, 0.0).arithmetic.reason, ArithmeticReason::kZeroTolerance);
  EXPECT_EQ(SolveWithin(kPendulum, 1e-17).arithmetic.reason, ArithmeticReason::kBoundTooLarge);
  pendulum::Problem on_the_limit = kPendulum;
  on_the_limit.law = RestitutionLaw::kNewton;
  on_the_limit.coefficient = std::sqrt(0.5);
  EXPECT_EQ(SolveWithin(on_the_limit, 1e-12).arithmetic.reason, ArithmeticReason::kSignNotProved);
  EXPECT_EQ(SolveWithin(kContact, 1e-12).arithmetic.reason, ArithmeticReason::kWithinTolerance);
  EXPECT_EQ(SolveWithin(kContact, 0.0).arithmetic.reason, ArithmeticReason::kZeroTolerance);
  EXPECT_EQ(SolveWithin(kContact, 1e-17).arithmetic.reason, ArithmeticReason::kBoundTooLarge);
}

TEST(SolveWithinTest, ContactThatSeparatesKeepsItsVelocity) {
  pendulum::Problem pendulum = kPendulum;
  pendulum.omega_minus = 1.0;
  EXPECT_EQ(SolveWithin(pendulum, 1e-12).impact.regime, Regime::kSeparating);
  EXPECT_EQ(SolveWithin(pendulum, 1e-12).impact[pendulum::Output::kNormalVelocityAfter], 0.3);
  planar::Problem contact = kContact;
  contact.v0 = 1.0;
  EXPECT_EQ(SolveWithin(contact, 1e-12).impact.regime, Regime::kSeparating);
  EXPECT_EQ(SolveWithin(contact, 1e-12).impact.v1, 1.0);
}

// The distance of two numbers over a scale, which may be 0 if they agree.
double Distance(double x, double y, double scale) { return x == y ? 0.0 : std::fabs(x - y) / scale; }

// The largest difference of two impacts as SolvedImpact::relative_error counts it.
double Difference(const pendulum::Problem& problem, const pendulum::Impact& x, const pendulum::Impact& y) {
  using enum pendulum::Output;
  const double b = std::fabs(problem.b);
  const double speed = std::max(problem.a, b) * -problem.omega_minus;
  const double normal = speed * problem.inertia / (problem.a * problem.a);
  const double tangential = speed * problem.inertia / (b * b);
  const double eta = y[kEnergetic];
  const double moved = 0.5 * problem.inertia * problem.omega_minus * problem.omega_minus * (1.0 + eta * eta);
  double worst = 0.0;
  const auto compare = [&](std::initializer_list<pendulum::Output> outputs, double scale) {
    for (const pendulum::Output output : outputs) worst = std::max(worst, Distance(x[output], y[output], scale));
  };
  compare({kTangentialVelocityAfter, kNormalVelocityAfter}, speed);
  compare({kNormalImpulseCompression, kNormalImpulse}, normal);
  compare({kTangentialImpulseCompression, kTangentialImpulse}, tangential);
  compare({kWorkNormalCompression, kWorkNormalRestitution, kWorkTangentialCompression, kWorkTangentialRestitution,
           kWorkNormal, kWorkTangential, kEnergyChange},
          moved);
  for (const pendulum::Output output : {kNewton, kPoisson, kEnergetic}) compare({output}, y[output]);
  compare({kTangentialCoefficient}, problem.mu);
  return worst;
}

double Difference(const planar::Problem& problem, const planar::Impact& x, const planar::Impact& y) {
  const double speed = std::max(std::fabs(problem.u0), std::fabs(problem.v0));
  const double moved = std::fabs(y.work_normal_compression) + std::fabs(y.work_normal_restitution) +
                       std::fabs(y.work_tangential_compression) + std::fabs(y.work_tangential_restitution);
  return std::max({Distance(x.u1, y.u1, speed), Distance(x.v1, y.v1, speed),
                   Distance(problem.w.nn * x.tau1, problem.w.nn * y.tau1, speed),
                   Distance(problem.w.nn * x.tau_compression, problem.w.nn * y.tau_compression, speed),
                   Distance(problem.w.tt * x.f1, problem.w.tt * y.f1, speed),
                   Distance(problem.w.tt * x.f_compression, problem.w.tt * y.f_compression, speed),
                   Distance(x.work_normal_compression, y.work_normal_compression, moved),
                   Distance(x.work_normal_restitution, y.work_normal_restitution, moved),
                   Distance(x.work_tangential_compression, y.work_tangential_compression, moved),
                   Distance(x.work_tangential_restitution, y.work_tangential_restitution, moved),
                   Distance(x.energy_change, y.energy_change, moved)});
}

// Both arithmetics answer the same impact within the sum of their bounds, and never with another regime or limit. The
// products of this test are rounded, too, by less than 2^-50.
template <typename Problem>
void ExpectAgreement(const Problem& problem, int scene) {
  SCOPED_TRACE(scene);
  const auto exact = SolveWithin(problem, 0.0);
  if (exact.impact.regime == Regime::kSeparating) return;
  for (const double tolerance : {4e-15, 1e-12, 1e-6}) {
    const auto solved = SolveWithin(problem, tolerance);
    ASSERT_EQ(solved.impact.regime, exact.impact.regime);
    ASSERT_EQ(solved.impact.sharp_limit_broken, exact.impact.sharp_limit_broken);
    ASSERT_EQ(solved.impact.energy_limit_broken, exact.impact.energy_limit_broken);
    if (solved.arithmetic.arithmetic != Arithmetic::kPlain) continue;
    ASSERT_LE(solved.relative_error(), tolerance);
    ASSERT_LE(Difference(problem, solved.impact, exact.impact),
              solved.relative_error() + exact.relative_error() + 0x1p-50);
  }
}

TEST(SolveWithinTest, PromisesVelocitiesImpulsesWorksAndCoefficientsOfPendulums) {
  pendulum::SceneSource source(1);
  for (int i = 0; i < 20'000 && !HasFailure(); ++i) {
    pendulum::Problem problem = source.Everyday();
    if (i % 2 == 1) {
      problem = source.NearSignChange(
          static_cast<pendulum::SceneSource::SignChange>(i / 2 % pendulum::SceneSource::kSignChanges),
          source.NearlyOne());
    }
    ExpectAgreement(problem, i);
  }
}

TEST(SolveWithinTest, PromisesVelocitiesImpulsesAndWorksOfPlanarContacts) {
  planar::SceneSource source(2);
  for (int i = 0; i < 20'000 && !HasFailure(); ++i) {
    planar::Problem problem = source.Everyday();
    if (i % 2 == 1) {
      problem = source.NearSignChange(
          static_cast<planar::SceneSource::SignChange>(i / 2 % planar::SceneSource::kSignChanges), source.NearlyOne());
    }
    ExpectAgreement(problem, i);
  }
}

TEST(ToleranceLeftTest, IsWhatTheEffectsLeftOutDoNotUse) {
  EXPECT_EQ(ToleranceLeft(1e-12, 0.0), 1e-12);
  EXPECT_EQ(ToleranceLeft(0.5, 0.125), 0.375);
  EXPECT_EQ(ToleranceLeft(1e-12, 1e-12), 0.0);
  EXPECT_EQ(ToleranceLeft(1e-12, 1e-3), 0.0);
  EXPECT_EQ(ToleranceLeft(0.0, std::numeric_limits<double>::infinity()), 0.0);
}

TEST(ToleranceLeftTest, SumWithTheEffectsLeftOutNeverExceedsTheTolerance) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> exponent(-60.0, -1.0);
  for (int i = 0; i < 100'000; ++i) {
    const double tolerance = std::exp2(exponent(random));
    const double neglected = std::min(tolerance, std::exp2(exponent(random)));
    const double left = ToleranceLeft(tolerance, neglected);
    ASSERT_GE(left, 0.0);
    ASSERT_LE(left + neglected, tolerance);
    ASSERT_GE(left + neglected, tolerance * (1.0 - 0x1p-51));
  }
}

}  // namespace
}  // namespace ricochet
