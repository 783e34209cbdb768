// The compliant model claims at least the error that it makes, and little more. `ricochet_claims` takes more scenes.

#include "tests/support/compliant_claims.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/support/claims.h"

namespace ricochet::compliant {
namespace {

TEST(CompliantClaimsTest, DeceiveNobodyAndAreUseful) {
  for (const bool hard : {false, true}) {
    const ClaimTally tally = ClaimsOf(hard, 200, 31);
    PrintClaims("compliant", hard ? "hard" : "typical", tally);
    EXPECT_EQ(tally.deceived(), 0);
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

}  // namespace
}  // namespace ricochet::compliant
