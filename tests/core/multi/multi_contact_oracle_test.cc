// Random scenes of several contacts against an oracle of 128 bits that shares no code with the core. `./dev claims`
// takes 10,000.

#include <gtest/gtest.h>

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
