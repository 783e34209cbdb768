// Random scenes of several contacts against an oracle of 128 bits that shares no code with the core. `./dev claims`
// takes 10,000.

#include "tests/support/oracles/multi_contact_oracle.h"

#include <gtest/gtest.h>

#include <algorithm>
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

void ExpectWithinErrors(const Problem& problem, const Attained& found, const ExactOutcome& exact) {
  for (int j = 0; j < found.v.size(); ++j) {
    EXPECT_NEAR(found.v(j), exact.v[static_cast<size_t>(j)], found.ErrorOf(problem, j)) << j;
  }
}

// A ball stops at a wall that gives nearly nothing back, and a second ball presses it on. Each time the wall lets go it
// is loaded again, and what rounding has made of v_n = 1e-6 meanwhile weighs a million times more.
TEST(MultiContactOracleTest, AnErrorOfAContactThatIsLoadedAgainWeighsMore) {
  for (const double stiffness : {1.0, 2.0, 4.0, 8.0, 16.0, 32.0, 64.0}) {
    SCOPED_TRACE(stiffness);
    Problem balls = {.d = 2, .k = 2, .w = Eigen::MatrixXd::Zero(4, 4), .v = Vector::Zero(4)};
    balls.laws = {{.e = 0.984375, .stiffness = 0.0625}, {.e = 1e-6, .stiffness = stiffness}};
    balls.w(1, 1) = 1.296875;
    balls.w(1, 3) = balls.w(3, 1) = -0.25;
    balls.w(3, 3) = 0.25;
    balls.v(1) = 0.375;
    balls.v(3) = -0.484375;
    const Attained found = FindSprings(balls, std::nullopt, [] { return false; });
    const auto exact = SpringsExactly(balls, 400);
    ASSERT_TRUE(exact.has_value());
    ExpectWithinErrors(balls, found, *exact);
    EXPECT_LT(found.ErrorOf(balls, 1), 1e-6);
  }
}

// Friction changes its mode while the force of a plastic contact falls. The limit of small coefficients is 3e-9 away.
TEST(MultiContactOracleTest, FrictionThatChangesWhileAForceFallsMakesAnError) {
  constexpr uint64_t kSeed = 83;
  std::mt19937_64 random(kSeed);
  Problem problem = RandomMultiContact(random, /*springs=*/true);
  problem.laws = {{.mu = 0.1875, .e = 0.21875, .stiffness = 0.125},
                  {.mu = 0.75, .e = 0.0, .stiffness = 256.0},
                  {.mu = 0.0, .e = 1.0, .stiffness = 64.0}};
  const Attained found = FindSprings(problem, std::nullopt, [] { return false; });
  for (ContactLaw& law : problem.laws) law.e = std::max(law.e, 0x1p-44);
  const auto exact = SpringsExactly(problem, 600);
  ASSERT_TRUE(exact.has_value());
  ExpectWithinErrors(problem, found, *exact);
  EXPECT_FALSE(found.error_is_proved);
}

}  // namespace
}  // namespace ricochet::multi
