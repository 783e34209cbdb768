// The model of finite duration claims at least the error that it makes. `ricochet_claims` takes more scenes.

#include "tests/support/claims/finite_duration_claims.h"

#include <gtest/gtest.h>

#include "tests/support/claims/claims.h"

namespace ricochet::finite_duration {
namespace {

class FiniteDurationClaimsTest : public testing::TestWithParam<double> {};

// What a path without forces, damping and a spring along t lacks follows from the path itself. At 1e-12 little but
// rounding is left.
TEST_P(FiniteDurationClaimsTest, WithoutForcesTheToleranceIsMetAndLittleMoreIsClaimed) {
  for (const ClaimKind kind : {ClaimKind::kLinear, ClaimKind::kHertz}) {
    for (const bool hard : {false, true}) {
      const ClaimTally tally = ClaimsOf(kind, hard, GetParam(), 100, 31);
      PrintClaims(kind == ClaimKind::kHertz ? "duration, Hertz" : "duration, linear", hard ? "hard" : "typical", tally);
      EXPECT_EQ(tally.broken(), 0) << tally.first_broken();
      EXPECT_EQ(tally.claimed_above_tolerance(), 0);
      EXPECT_LE(tally.MedianRatio(), GetParam() > 1e-12 ? 1.6 : 6.0);
    }
  }
}

TEST_P(FiniteDurationClaimsTest, WithASpringAlongTNobodyIsDeceived) {
  const ClaimTally tally = ClaimsOf(ClaimKind::kCompliant, /*hard=*/false, GetParam(), 100, 32);
  PrintClaims("duration, compliant", "typical", tally);
  EXPECT_EQ(tally.broken(), 0) << tally.first_broken();
  EXPECT_LE(tally.MedianRatio(), 50.0);
}

// Scenes 4725 and 3830 of ricochet_claims, in which the local errors of the velocities alone claim a quarter of the
// error: the tangential spring carries more of it than they do.
TEST_P(FiniteDurationClaimsTest, WhereTheSpringCarriesTheErrorNobodyIsDeceived) {
  ClaimScenes scenes(ClaimKind::kCompliant, /*hard=*/false, 77);
  for (int i = 0; i <= 4725; ++i) {
    Problem problem = scenes.Next();
    if (i != 3830 && i != 4725) continue;
    problem.tolerance = GetParam();
    const Impact impact = Solve(problem);
    EXPECT_GE(impact.error_estimate, ErrorOf(problem, impact, *ClosedForm(problem))) << "scene " << i;
  }
}

INSTANTIATE_TEST_SUITE_P(Tolerances, FiniteDurationClaimsTest, testing::ValuesIn(kClaimTolerances));

}  // namespace
}  // namespace ricochet::finite_duration
