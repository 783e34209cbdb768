// The errors of the velocities of a mechanism after the impact, against arbitrary precision.

#include "core/answer/rates_errors.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <cmath>
#include <optional>

#include "ricochet/solver.h"
#include "tests/support/claims/claims.h"
#include "tests/support/claims/mechanism_claims.h"
#include "tests/support/scenes/random_scenes.h"
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

// Two coordinates z of a contact in space with M = diag(1, 1/8), u = z' and v = z1'/2, written as z = (q1 + q2, q2).
// Slip from (-1, 1/4) turns towards (-1, 0) and stops as compression ends.
Scene TwoCoordinates(double friction) {
  return {.system = Mechanism{.mass_matrix = {1.0, 1.0, 1.0, 1.125},
                              .jacobian = {1.0, 1.0, 0.0, 1.0, 0.5, 0.5},
                              .rates = {-1.25, 0.25}},
          .friction = {.kinetic_coefficient = friction},
          .restitution = NewtonCoefficient{0.5}};
}

TEST(RatesErrorsTest, AreKnownWhereTwoCoordinatesLock) {
  const Outcome outcome = Solve(TwoCoordinates(1.0));
  EXPECT_EQ(outcome.regime, Regime::kLocked);
  for (size_t i = 0; i < 2; ++i) {
    EXPECT_LT(outcome.errors.rates_after[i], 1e-13);
    EXPECT_LE(std::fabs(outcome.rates_after[i]), outcome.errors.rates_after[i]);
    EXPECT_LT(outcome.errors.momentum_change[i], 1e-12);
  }
  EXPECT_NEAR(outcome.momentum_change[0], 1.0, outcome.errors.momentum_change[0]);
  EXPECT_NEAR(outcome.momentum_change[1], 0.96875, outcome.errors.momentum_change[1]);
}

// wtn = (1/2, 0), so that slip starts again along (1, 0), until v = 1/4.
TEST(RatesErrorsTest, AreKnownWhereSlipOfTwoCoordinatesReversesAsCompressionEnds) {
  const Outcome outcome = Solve(TwoCoordinates(0.25));
  for (size_t i = 0; i < 2; ++i) {
    EXPECT_LT(outcome.errors.rates_after[i], 1e-9);
    EXPECT_NEAR(outcome.rates_after[i], i == 0 ? 0.5 : 0.0, outcome.errors.rates_after[i]);
  }
}

using Pair = Eigen::Matrix<long double, 2, 1>;
using Square = Eigen::Matrix<long double, 2, 2>;

// The rates after an impact of two coordinates in space under Newton's law whose slip stops as compression ends;
// nothing where it does not. With v = a.u, slip e turns by the sign of e'.Wtt (a - mu e), e' across e, wherever it is.
std::optional<Pair> RatesAfterStop(const Mechanism& mechanism, long double friction, long double restitution) {
  Square mass, tangential;
  Pair normal, rates;
  for (Eigen::Index i = 0; i < 2; ++i) {
    for (Eigen::Index j = 0; j < 2; ++j) {
      mass(i, j) = mechanism.mass_matrix[static_cast<size_t>(2 * i + j)];
      tangential(i, j) = mechanism.jacobian[static_cast<size_t>(2 * i + j)];
    }
    normal(i) = mechanism.jacobian[static_cast<size_t>(4 + i)];
    rates(i) = mechanism.rates[static_cast<size_t>(i)];
  }
  const Square wtt = tangential * mass.inverse() * tangential.transpose();
  const Pair a = tangential.transpose().inverse() * normal;
  const Pair u0 = tangential * rates;
  const auto direction = [](long double angle) { return Pair(std::cos(angle), std::sin(angle)); };
  const auto turn = [&](long double angle) {
    const Pair e = direction(angle);
    return Pair(-e(1), e(0)).dot(wtt * (a - friction * e));
  };
  long double angle = std::atan2(u0(1), u0(0));
  const long double step = std::copysign(1e-3L, turn(angle));
  while (step * turn(angle) > 0.0L) {
    angle += step;
    if (a.dot(direction(angle)) >= 0.0L) return std::nullopt;
  }
  if (a.norm() <= friction) return Pair(0.0L, 0.0L);
  // Slip starts again along e with Wtt (a - mu e) = h e, that is (h + mu Wtt) e = Wtt a, and h > 0.
  const auto along = [&](long double h) -> Pair {
    return (h * Square::Identity() + friction * wtt).inverse() * wtt * a;
  };
  long double low = 0.0L, high = (wtt * a).norm();
  for (int i = 0; i < 80; ++i) {
    const long double middle = 0.5L * (low + high);
    (along(middle).norm() > 1.0L ? low : high) = middle;
  }
  return tangential.inverse() * along(low) * (-restitution * a.dot(u0) / a.dot(along(low)));
}

TEST(RatesErrorsTest, ClaimNoLessThanTheyAreWhereSlipOfTwoCoordinatesStopsAsCompressionEnds) {
  RandomScenes random(kSeed);
  ClaimTally tally;
  for (int i = 0; i < 1000; ++i) {
    Mechanism mechanism = {.jacobian = random.Three(1.0)};
    const Eigen::MatrixXd mass = mechanism_claims::MassOf(2, 3.0, random);
    mechanism.mass_matrix.assign(mass.data(), mass.data() + 4);
    for (const double entry : random.Three(1.0)) mechanism.jacobian.push_back(entry);
    mechanism.rates = {random.Uniform(-2.0, 2.0), random.Uniform(-2.0, 2.0)};
    const double v0 = mechanism.jacobian[4] * mechanism.rates[0] + mechanism.jacobian[5] * mechanism.rates[1];
    if (v0 > 0.0) mechanism.rates = {-mechanism.rates[0], -mechanism.rates[1]};
    const double friction = random.Power(-2.0, 1.0), restitution = random.Uniform(0.0, 1.0);
    const Outcome outcome = Solve({.system = mechanism,
                                   .friction = {.kinetic_coefficient = friction},
                                   .restitution = NewtonCoefficient{restitution}});
    const std::optional<Pair> exact = RatesAfterStop(mechanism, friction, restitution);
    if (!exact.has_value()) {
      // The error of a mechanism that is at rest is all of its rate.
      EXPECT_NE(outcome.errors.rates_after[0], std::fabs(outcome.rates_after[0])) << "scene " << i;
      continue;
    }
    for (size_t k = 0; k < 2; ++k) {
      const long double error = std::fabs(outcome.rates_after[k] - (*exact)(static_cast<Eigen::Index>(k)));
      tally.Add(outcome.errors.rates_after[k], static_cast<double>(error), "scene " + std::to_string(i));
    }
  }
  EXPECT_GT(tally.count(), 300);
  ExpectHonest(tally);
}

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
