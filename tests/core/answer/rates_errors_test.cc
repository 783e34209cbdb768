// The errors of the velocities of a mechanism after the impact, against arbitrary precision.

#include "core/answer/rates_errors.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <cmath>

#include "ricochet/solver.h"
#include "tests/support/claims/mechanism_claims.h"
#include "tests/support/scenes/system_scenes.h"

namespace ricochet {
namespace {

constexpr uint64_t kSeed = 2811;

void ExpectHonest(const ClaimTally& tally) {
  EXPECT_EQ(tally.broken(), 0) << tally.first_broken() << ", least ratio " << tally.LeastRatio();
  EXPECT_LT(tally.unknown(), tally.count() / 50 + 1);
}

// `./dev claims` holds 10,000 of each kind.
TEST(RatesErrorsTest, ClaimNoLessThanTheyAreForPlanarMechanisms) {
  for (const bool hard : {false, true}) {
    const MechanismClaims claims = MechanismClaimsOf(/*in_space=*/false, hard, 400, kSeed);
    EXPECT_GT(claims.rates.count(), 1500);
    ExpectHonest(claims.rates);
    ExpectHonest(claims.momentum);
  }
}

TEST(RatesErrorsTest, ClaimNoLessThanTheyAreForMechanismsInSpace) {
  for (const bool hard : {false, true}) {
    const MechanismClaims claims = MechanismClaimsOf(/*in_space=*/true, hard, 120, kSeed);
    EXPECT_GT(claims.rates.count(), 50);
    ExpectHonest(claims.rates);
    ExpectHonest(claims.momentum);
  }
}

// Those that are held move on, so that slip keeps a part that no impulse changes.
TEST(RatesErrorsTest, ClaimNoLessThanTheyAreForOneFreeCoordinateInSpace) {
  const MechanismClaims claims = MechanismClaimsOf(/*in_space=*/true, /*hard=*/false, 400, kSeed, /*one_free=*/true);
  EXPECT_GT(claims.rates.count(), 500);
  ExpectHonest(claims.rates);
  ExpectHonest(claims.momentum);
}

Outcome Solve(const Scene& scene) { return LocalSolver().Solve({.scene = scene})->outcome; }

TEST(RatesErrorsTest, AreAFewRoundingsForAWellConditionedMechanism) {
  const Outcome outcome = Solve(With(Arm()));
  for (const double error : outcome.errors.rates_after) EXPECT_LT(error, 1e-13);
  for (const double error : outcome.errors.momentum_change) EXPECT_LT(error, 1e-13);
}

TEST(RatesErrorsTest, AreZeroForCoordinatesThatAreHeld) {
  Mechanism arm = Arm();
  arm.kept_coordinates = {1};
  const Outcome outcome = Solve(With(arm));
  EXPECT_EQ(outcome.errors.rates_after[1], 0.0);
  EXPECT_EQ(outcome.rates_after[1], arm.rates[1]);
  EXPECT_GT(outcome.errors.rates_after[0], 0.0);
}

// The exact rates are -1 + (1 + 0.5) and so on: M = 2, J = (0, 1).
TEST(RatesErrorsTest, AreKnownForOneCoordinate) {
  const Mechanism one = {.mass_matrix = {2.0}, .jacobian = {0.3, 1.0}, .rates = {-1.0}};
  const Outcome outcome = Solve(With(one));
  ASSERT_EQ(outcome.errors.rates_after.size(), 1U);
  EXPECT_LT(outcome.errors.rates_after[0], 1e-13);
}

// Where J has the rows c j and j, u = c v, and slip turns round as compression ends: v' = Wnn (1 + mu c) before and
// Wnn (1 - mu c) after, so that v+ = -e v- sqrt((1 - mu c)/(1 + mu c)).
TEST(RatesErrorsTest, AreKnownWhereRowsOfTheJacobianAreParallel) {
  constexpr double kSlope = 0.25, kFriction = 0.5, kEnergetic = 0.5;
  Mechanism arm = Arm();
  for (size_t i = 0; i < 3; ++i) arm.jacobian[i] = kSlope * arm.jacobian[3 + i];
  const Outcome outcome = Solve(With(arm));
  EXPECT_EQ(outcome.w_rank, 1);
  const Eigen::Map<const Eigen::Matrix3d> mass(arm.mass_matrix.data());
  const Eigen::Map<const Eigen::Vector3d> rates(arm.rates.data()), row(arm.jacobian.data() + 3);
  const Eigen::Vector3d direction = mass.ldlt().solve(row);
  const double v0 = row.dot(rates);
  const double v1 = -kEnergetic * v0 * std::sqrt((1 - kFriction * kSlope) / (1 + kFriction * kSlope));
  const Eigen::Vector3d after = rates + direction * ((v1 - v0) / row.dot(direction));
  for (size_t i = 0; i < 3; ++i) {
    EXPECT_LT(outcome.errors.rates_after[i], 1e-12);
    EXPECT_NEAR(outcome.rates_after[i], after(static_cast<Eigen::Index>(i)), 1e-14);
  }
}

// A planar arm in space has a row of J that is 0.
TEST(RatesErrorsTest, AreKnownWhereARowOfTheJacobianIsZero) {
  Mechanism arm = Arm(/*in_space=*/true);
  for (size_t i = 3; i < 6; ++i) arm.jacobian[i] = 0.0;
  const Outcome in_space = Solve(With(arm));
  const Outcome in_plane = Solve(With(Arm()));
  for (size_t i = 0; i < 3; ++i) {
    EXPECT_LT(in_space.errors.rates_after[i], 1e-9);
    EXPECT_NEAR(in_space.rates_after[i], in_plane.rates_after[i], 1e-11);
  }
}

}  // namespace
}  // namespace ricochet
