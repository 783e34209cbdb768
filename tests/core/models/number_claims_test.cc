// Every model claims at least the error of each of its numbers, on the number's own scale: of velocities, coefficients,
// impulses and works. `ricochet_claims` takes more scenes.

#include "tests/support/claims/number_claims.h"

#include <gtest/gtest.h>

#include <cmath>
#include <optional>
#include <string>

#include "tests/support/claims/compliant_claims.h"
#include "tests/support/claims/finite_duration_claims.h"
#include "tests/support/claims/pendulum_claims.h"
#include "tests/support/claims/planar_claims.h"
#include "tests/support/claims/sliding_claims.h"
#include "tests/support/claims/spatial_number_claims.h"
#include "tests/support/scenes/spatial_contact.h"

namespace ricochet {
namespace {

constexpr int kCount = 300;
constexpr uint64_t kSeed = 41;

// At most `unknown` of all numbers may have no error.
void Expect(const NumberClaims& claims, const char* method, double unknown) {
  const auto check = [&](const char* kind, const ClaimTally& tally) {
    PrintClaims(std::string(method) + ", " + kind, "", tally);
    EXPECT_EQ(tally.broken(), 0) << method << ", " << kind << ": " << tally.first_broken();
    EXPECT_LE(tally.unknown(), unknown * tally.count()) << method << ", " << kind;
  };
  check("velocities", claims.velocity);
  check("coefficients", claims.coefficient);
  check("impulses", claims.impulse);
  check("works", claims.work);
}

class NumberClaimsTest : public testing::TestWithParam<bool> {};

TEST_P(NumberClaimsTest, OfThePendulumAreKept) {
  Expect(pendulum::NumberClaimsOf(true, GetParam(), kCount, kSeed), "plain", GetParam() ? 0.5 : 0.02);
  Expect(pendulum::NumberClaimsOf(false, GetParam(), kCount, kSeed), "compensated", GetParam() ? 0.1 : 0.0);
}

TEST_P(NumberClaimsTest, OfThePendulumToFirstOrderAreKept) {
  Expect(first_order::NumberClaimsOf(true, GetParam(), kCount, kSeed), "with friction", 0.0);
  Expect(first_order::NumberClaimsOf(false, GetParam(), kCount, kSeed), "without", 0.0);
}

TEST_P(NumberClaimsTest, OfThePlanarModelAreKept) {
  for (const bool grazing : {false, true}) {
    Expect(planar::NumberClaimsOf(planar::SolvePlain, GetParam(), grazing, kCount, kSeed), "plain", 1.0);
    Expect(planar::NumberClaimsOf(planar::InDoubleDouble, GetParam(), grazing, kCount, kSeed), "compensated", 0.2);
  }
}

TEST_P(NumberClaimsTest, OfStraightSlipAndNoFrictionAreKept) {
  for (const bool friction : {true, false}) {
    for (const bool grazing : {false, true}) {
      Expect(sliding::NumberClaimsOf<1>(friction, GetParam(), grazing, kCount, kSeed), "2D", GetParam() ? 0.5 : 0.0);
      Expect(sliding::NumberClaimsOf<2>(friction, GetParam(), grazing, kCount, kSeed), "3D", GetParam() ? 0.5 : 0.0);
    }
  }
}

TEST(NumberClaimsOfSpaceTest, AreKeptWhereSlipKeepsAPart) {
  spatial::SceneSource source(kSeed);
  NumberClaims claims;
  for (int i = 0; i < kCount; ++i) {
    spatial::Problem problem = source.WithPartThatStays();
    problem.tolerance = i % 2 == 0 ? 1e-6 : 1e-12;
    spatial::AddNumbers(problem, claims);
  }
  Expect(claims, "part stays", 0.02);
}

// Friction locks such a contact where compression ends, and rounding decides on which side.
TEST(NumberClaimsOfSpaceTest, OfCoefficientsAreKeptWhereAContactOfRankTwoLocks) {
  spatial::SceneSource source(kSeed);
  NumberClaims claims;
  for (int i = 0; i < kCount; ++i) {
    spatial::Problem problem = source.WithDegreesOfFreedom(2);
    problem.mu = problem.mu_static = std::pow(10.0, source.Uniform(0.0, 9.0));
    problem.tolerance = i % 2 == 0 ? 1e-6 : 1e-12;
    spatial::AddNumbers(problem, claims);
  }
  EXPECT_EQ(claims.coefficient.broken(), 0) << claims.coefficient.first_broken();
  EXPECT_EQ(claims.velocity.broken(), 0) << claims.velocity.first_broken();
  EXPECT_EQ(claims.work.broken(), 0) << claims.work.first_broken();
}

TEST_P(NumberClaimsTest, OfTheSpatialModelAreKept) {
  for (const double tolerance : {1e-2, 1e-6, 1e-12}) {
    Expect(spatial::NumberClaimsOf(GetParam(), tolerance, kCount, kSeed), "space", GetParam() ? 0.1 : 0.02);
  }
}

TEST_P(NumberClaimsTest, OfGrazingImpactsInSpaceAreKept) {
  for (const double tolerance : {1e-6, 1e-12}) {
    Expect(spatial::GrazingClaimsOf(GetParam(), tolerance, kCount, kSeed), "grazing", 0.02);
  }
}

TEST_P(NumberClaimsTest, OfTheCompliantModelAreKept) {
  Expect(compliant::NumberClaimsOf(GetParam(), kCount / 6, kSeed), "compliant", GetParam() ? 0.6 : 0.1);
}

TEST_P(NumberClaimsTest, OfFiniteDurationAreKeptAndCoverWhatItsLedgerLacks) {
  using finite_duration::ClaimKind;
  for (const double tolerance : {1e-4, 1e-12}) {
    for (const ClaimKind kind : {ClaimKind::kLinear, ClaimKind::kHertz, ClaimKind::kCompliant}) {
      Expect(finite_duration::NumberClaimsOf(kind, GetParam(), tolerance, kCount / 6, kSeed), "duration",
             GetParam() ? 0.6 : 0.1);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Scenes, NumberClaimsTest, testing::Bool(),
                         [](const auto& test) { return test.param ? "Hard" : "Typical"; });

// The impulses have no known errors at rank one, which no restitution multiplies by 0.
TEST(FiniteDurationNumberClaimsTest, NoErrorAtRankOneWithoutRestitutionIsNaN) {
  const finite_duration::Problem problem = {
      .contact = {.w = {0.25, -0.5, 1.0}, .u0 = 0.5, .v0 = -1.0, .mu = 0.1, .mu_static = 0.1, .coefficient = 0.0},
      .spring = LinearSpring{1e6}};
  const ImpactErrors errors = finite_duration::Solve(problem).errors;
  EXPECT_EQ(errors.tau, ImpactErrors::kUnknown);
  EXPECT_LE(errors.work_normal_restitution, 1e-9);
  EXPECT_EQ(errors.work_tangential_restitution, ImpactErrors::kUnknown);
}

// Coefficients, v and the normal impulse at the tightest tolerance, for |v0|/|u0| from 1 down to 1e-300. Where friction
// can jam the contact, v becomes as large as slip, and what restitution asks for is below the digits of any oracle.
TEST(GrazingTest, TheNormalPartIsRightToTwelveDigitsHoweverSmallItIs) {
  spatial::SceneSource source(42);
  for (int i = 0; i < 1'000;) {
    spatial::Problem problem = spatial::GrazingScene(source, false, 0.5, i % 2 == 0 ? 20.0 : 300.0);
    problem.tolerance = spatial::kLeastTolerance;
    if (problem.mu * std::hypot(problem.w13, problem.w23) >= problem.w33) continue;
    const std::optional<spatial::ExactImpact> exact = spatial::SolveExactly(problem);
    if (!exact.has_value()) continue;
    ++i;
    const spatial::Impact impact = spatial::Solve(problem);
    const ComparedNumbers found = Compare(impact, *exact);
    for (const ComparedNumber* number :
         {&found.newton, &found.poisson, &found.energetic, &found.tangential, &found.v, &found.tau}) {
      ASSERT_LE(number->reached, 1e-12 * number->size) << spatial::ToString(problem);
    }
    ASSERT_LE(impact.errors.newton, 1e-10 * impact.newton) << spatial::ToString(problem);
  }
}

// Friction takes v from 1e-154 to the size of slip and back, and Newton's law ends it at e |v0|.
TEST(GrazingTest, NewtonsLawEndsAJamAtItsOwnScale) {
  const spatial::Problem problem =
      spatial::Contact({0x1.e9aa9a3b278d4p-4, 0x1.31f6e85e77883p-5, -0x1.f35ac2238437p-9, 0x1.dd431497368c9p-1,
                        -0x1.50f43cff782bp+0, 0x1.2e2d020ab2cd8p+1},
                       {-0x1.fef8e47a43334p-2, -0x1.3335db5cd45e8p-3}, -0x1.427bf4fa1a29ep-511, 0x1.a3ccbdd961befp+4,
                       {.law = RestitutionLaw::kNewton, .coefficient = 0x1.cddce1855495cp-1, .tolerance = 1e-12});
  const std::optional<spatial::ExactImpact> exact = spatial::SolveExactly(problem);
  ASSERT_TRUE(exact.has_value());
  const spatial::Impact impact = spatial::Solve(problem);
  EXPECT_DOUBLE_EQ(impact.v1, -problem.coefficient * problem.v0);
  NumberClaims claims;
  claims.Add(impact.errors, Compare(impact, *exact), spatial::ToString(problem));
  EXPECT_EQ(claims.broken(), 0);
}

TEST(GrazingTest, StraightSlipOfRankOneInSpaceHasAnErrorOfSomeRoundings) {
  const double a[] = {1.0, 0.5, -0.7};
  for (const double mu : {0.1, 0.3, 1.0, 5.0}) {
    spatial::Problem problem =
        spatial::Contact({a[0] * a[0], a[0] * a[1], a[0] * a[2], a[1] * a[1], a[1] * a[2], a[2] * a[2]}, {a[0], a[1]},
                         a[2], mu, {.coefficient = 0.8, .tolerance = 1e-12});
    EXPECT_LE(spatial::Solve(problem).error_estimate, 1e-14) << mu;
  }
}

}  // namespace
}  // namespace ricochet
