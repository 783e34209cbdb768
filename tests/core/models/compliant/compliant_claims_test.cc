// The compliant model claims at least the error that it makes, and little more. `ricochet_claims` takes more scenes.

#include "tests/support/claims/compliant_claims.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/support/claims/claims.h"

namespace ricochet::compliant {
namespace {

TEST(CompliantClaimsTest, DeceiveNobodyAndAreUseful) {
  for (const bool hard : {false, true}) {
    const ClaimTally tally = ClaimsOf(hard, 200, 31);
    PrintClaims("compliant", hard ? "hard" : "typical", tally);
    EXPECT_EQ(tally.broken(), 0);
    EXPECT_LE(tally.MedianRatio(), 10.0);
    // The error of a wedged impact is not known.
    EXPECT_LE(tally.unknown(), hard ? 20 : 0);
  }
}

// Hundreds of sections: errors add up, and do not grow beyond that.
TEST(CompliantClaimsTest, LongPathsHaveSmallErrorsAndSaySo) {
  SceneSource source(32);
  int longest = 0;
  for (int i = 0; i < 300; ++i) {
    Problem problem = Everyday(source);
    problem.ratio_squared = source.LogUniform(1e-7, 1e-4);
    const Impact impact = Solve(problem);
    EXPECT_TRUE(impact.Converged()) << ToString(problem);
    EXPECT_LE(impact.error_estimate, 1e-10) << ToString(problem);
    longest = std::max(longest, static_cast<int>(impact.sections.size()));
  }
  EXPECT_GT(longest, 100);
}

// Found by `./dev claims`: 50 sections that repeat each other, whose roundings do not cancel as independent ones would.
TEST(CompliantClaimsTest, ALongPathOfLikeSectionsDeceivesNobody) {
  const Problem problem = {.contact = {.w = {0x1.b19e4e5178fe1p+6, -0x1.29e5c66c66e85p+6, 0x1.39e6c1e95fec1p+6},
                                       .u0 = 0x1.3c67c1dbd0f73p-8,
                                       .v0 = -0x1.0f05818b713bap-8,
                                       .mu = 0x1.98ff3db08cdaap-1,
                                       .coefficient = 0x1.fffffffaffed4p-1},
                           .ratio_squared = 0x1.9ddb4e9b543b7p-12};
  const Impact impact = Solve(problem);
  EXPECT_EQ(impact.sections.size(), 50U);
  EXPECT_GE(impact.error_estimate, VelocityError(problem, impact.u1, impact.v1, SolveExactly(problem)));
  EXPECT_LE(impact.error_estimate, 1e-14);
}

}  // namespace
}  // namespace ricochet::compliant
