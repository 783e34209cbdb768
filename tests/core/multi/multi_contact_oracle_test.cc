// Random scenes of several contacts against an oracle of 128 bits that shares no code with the core. `./dev claims`
// takes 10,000.

#include "tests/support/oracles/multi_contact_oracle.h"

#include <gtest/gtest.h>

#include <optional>

#include "absl/strings/str_cat.h"
#include "core/multi/springs.h"
#include "tests/support/claims/multi_contact_claims.h"

namespace ricochet::multi {
namespace {

TEST(MultiContactOracleTest, NoClaimIsBroken) {
  constexpr int kScenes = 150;
  const MultiContactClaims claims = MultiContactClaimsOf(kScenes, 1);
  const auto expect_kept = [](const char* name, const ClaimTally& tally, int least) {
    EXPECT_EQ(tally.broken(), 0) << name << ": " << tally.first_broken();
    EXPECT_GE(tally.count(), least) << name;
  };
  expect_kept("orders", claims.orders, 200);
  expect_kept("missing", claims.missing, 300);
  expect_kept("springs", claims.springs, 60);
  expect_kept("possible", claims.possible, 2000);
  expect_kept("energy", claims.energy, 1000);
  EXPECT_LE(claims.skipped, kScenes / 5);
}

// The stance foot of a walking robot moves by rounding only while the other foot strikes.
TEST(MultiContactOracleTest, AContactThatApproachesFarMoreSlowlyIsFollowedToItsEnd) {
  for (const double coupling : {0.3, 0.1, -0.1, -0.3}) {
    for (const double speed : {1e-2, 1e-3, 1e-4, 1e-6, 1e-9, 1e-12, 1e-17}) {
      for (const double e : {0.0, 0.5, 1.0}) {
        SCOPED_TRACE(absl::StrCat(coupling, ", ", speed, ", ", e));
        Problem problem = {.d = 2, .k = 2, .w = Eigen::MatrixXd::Identity(4, 4), .v = Vector::Zero(4)};
        problem.laws = {{.e = e}, {.e = e}};
        problem.w(1, 3) = problem.w(3, 1) = coupling;
        problem.v(1) = -speed;
        problem.v(3) = -1.0;
        const Attained springs = FindSprings(problem, std::nullopt, [] { return false; });
        EXPECT_NE(springs.end, MultiContactEnd::kBudgetUsedUp);
        if (e == 0.0) continue;  // The oracle has no plastic springs.
        const std::optional<ExactOutcome> exact = SpringsExactly(problem, 400);
        ASSERT_TRUE(exact.has_value());
        for (int i = 1; i < 4; i += 2) {
          EXPECT_NEAR(springs.v(i), exact->v[At(i)], springs.ErrorOf(problem, i));
          EXPECT_LT(springs.ErrorOf(problem, i), 1e-11);
        }
      }
    }
  }
}

// Three feet on one floor stick, and one of them reaches its cone. They divide friction anew, again and again, until
// all three are at their cones at once and slip.
TEST(MultiContactOracleTest, FeetThatDivideFrictionAnewSlipOnceItIsUsedUp) {
  constexpr uint64_t kSeed = 820;
  std::mt19937_64 random(kSeed);
  const Problem problem = RandomMultiContact(random, /*springs=*/true);
  const Attained springs = FindSprings(problem, std::nullopt, [] { return false; });
  EXPECT_EQ(springs.end, MultiContactEnd::kSeparated);
  EXPECT_LT(springs.events, 60);
  MultiContactClaims claims;
  AddClaims(problem, /*has_springs=*/true, "seed 820", claims);
  EXPECT_EQ(claims.springs.count(), 1);
  EXPECT_EQ(claims.springs.broken(), 0);
  EXPECT_EQ(claims.energy.broken(), 0);
}

}  // namespace
}  // namespace ricochet::multi
