// The spatial model claims at least the error that it makes, and little more. `ricochet_claims` takes more scenes.

#include "tests/support/claims/spatial_claims.h"

#include <gtest/gtest.h>

#include <cmath>

#include "absl/functional/function_ref.h"
#include "tests/support/claims/claims.h"

namespace ricochet::spatial {
namespace {

constexpr int kCount = 500;
constexpr uint64_t kSeed = 31;

class SpatialClaimsTest : public testing::TestWithParam<double> {
 protected:
  static ClaimTally TallyOf(const char* scenes, int count, absl::FunctionRef<Problem(SceneSource&)> next) {
    SceneSource source(kSeed);
    ClaimTally tally(GetParam());
    for (int i = 0; i < count; ++i) {
      Problem problem = next(source);
      problem.tolerance = GetParam();
      AddClaim(problem, tally);
    }
    PrintClaims("space", scenes, tally);
    return tally;
  }
};

TEST_P(SpatialClaimsTest, TypicalScenesAreWithinTheToleranceAndNotFarWithinIt) {
  const ClaimTally tally = SpatialClaims(/*hard=*/false, GetParam(), kCount, kSeed);
  PrintClaims("space", "typical", tally);
  EXPECT_EQ(tally.broken(), 0);
  EXPECT_EQ(tally.claimed_above_tolerance(), 0);
  EXPECT_LE(tally.MedianRatio(), 10.0);
  EXPECT_GE(tally.WorstError(), 0.1 * GetParam());
}

TEST_P(SpatialClaimsTest, HardScenesDeceiveNobody) {
  const ClaimTally tally = SpatialClaims(/*hard=*/true, GetParam(), kCount, kSeed);
  PrintClaims("space", "hard", tally);
  EXPECT_EQ(tally.broken(), 0);
  EXPECT_LE(tally.MedianRatio(), 12.0);
}

// Where W has rank two, v often vanishes with u, so that friction locks the contact.
TEST_P(SpatialClaimsTest, ScenesOfRankTwoDeceiveNobodyAndHaveAnError) {
  const ClaimTally tally = TallyOf("rank two", 2 * kCount, [](SceneSource& of) { return of.WithDegreesOfFreedom(2); });
  EXPECT_EQ(tally.broken(), 0);
  EXPECT_EQ(tally.unknown(), 0);
}

// Friction stops slip at once, however large it is, so that it does not make the claims large.
TEST_P(SpatialClaimsTest, ScenesOfLargeFrictionDeceiveNobodyAndAreWithinTheTolerance) {
  const ClaimTally tally = TallyOf("rough", 2 * kCount, [](SceneSource& of) {
    Problem problem = of.Typical();
    problem.mu = problem.mu_static = std::pow(10.0, of.Uniform(1.0, 9.0));
    return problem;
  });
  EXPECT_EQ(tally.broken(), 0);
  EXPECT_EQ(tally.unknown(), 0);
  EXPECT_LE(tally.claimed_above_tolerance(), kCount / 15);
}

// Steps along the one direction in which slip can change add their rounding, and no more.
TEST_P(SpatialClaimsTest, ScenesInWhichSlipKeepsAPartDeceiveNobodyAndAreWithinTheTolerance) {
  const ClaimTally tally = TallyOf("part stays", kCount, [](SceneSource& of) { return of.WithPartThatStays(); });
  EXPECT_EQ(tally.broken(), 0);
  EXPECT_EQ(tally.unknown(), 0);
  EXPECT_LE(tally.claimed_above_tolerance(), kCount / 50);
}

INSTANTIATE_TEST_SUITE_P(Tolerances, SpatialClaimsTest, testing::ValuesIn(kClaimTolerances));

}  // namespace
}  // namespace ricochet::spatial
