// Mechanisms reduced in lanes against the same ones alone, within the proved errors of those.

#include "core/contact/mechanism_lanes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "core/contact/mechanism.h"

namespace ricochet {
namespace {

// So many that no target has a lane for each, and some lanes of the last group are left.
constexpr size_t kStates = 19;

// Reduces states that differ in M, J and q' alone. `responses` has n x 3 numbers for each.
std::vector<MechanismState> Reduced(const std::vector<Mechanism>& mechanisms, std::vector<double>& responses) {
  const size_t n = mechanisms.front().rates.size();
  responses.assign(mechanisms.size() * 3 * n, 0.0);
  std::vector<MechanismState> states;
  for (const Mechanism& one : mechanisms) {
    states.push_back({.mass = one.mass_matrix.data(),
                      .jacobian = one.jacobian.data(),
                      .rates = one.rates.data(),
                      .response = &responses[states.size() * 3 * n]});
  }
  ReduceInLanes(mechanisms.front(), absl::MakeSpan(states));
  return states;
}

// M = S (A A^T + 1/c) S and J = B S for random A, B and diagonal S. The scaled condition of M is up to about c.
Mechanism RandomMechanism(size_t n, double condition, std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  const auto size = static_cast<Eigen::Index>(n);
  const auto random_matrix = [&](Eigen::Index rows, Eigen::Index columns) {
    return Eigen::MatrixXd::NullaryExpr(rows, columns, [&] { return normal(random); }).eval();
  };
  const Eigen::MatrixXd root = random_matrix(size, size);
  const Eigen::VectorXd sizes = (4.0 * random_matrix(size, 1)).array().exp();
  Eigen::MatrixXd mass = root * root.transpose() + Eigen::MatrixXd::Identity(size, size) / condition;
  mass = sizes.asDiagonal() * mass * sizes.asDiagonal();
  const Eigen::MatrixXd even = 0.5 * (mass + mass.transpose());
  const Eigen::MatrixXd jt = sizes.asDiagonal() * random_matrix(size, 3);
  const Eigen::VectorXd rates = random_matrix(size, 1);
  return {.mass_matrix = {even.data(), even.data() + even.size()},
          .jacobian = {jt.data(), jt.data() + jt.size()},
          .rates = {rates.begin(), rates.end()}};
}

void ExpectWithinTwiceTheErrors(const MechanismState& state, const Mechanism& mechanism) {
  const MechanismErrors alone(mechanism);
  size_t k = 0;
  for (Eigen::Index i = 0; i < 3; ++i) {
    for (Eigen::Index j = i; j < 3; ++j) EXPECT_NEAR(state.w[k++], alone.solved.w(i, j), 2.0 * alone.w(i, j));
    const auto at = static_cast<size_t>(i);
    EXPECT_NEAR(state.velocity[at], alone.motion.velocity[at], 2.0 * alone.velocity(i));
  }
  const FreePart part(mechanism);
  for (size_t i = 0; i < part.coordinates.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    for (Eigen::Index j = 0; j < 3; ++j) {
      EXPECT_NEAR(state.response[3 * part.coordinates[i] + j], part.scales(row) * alone.solved.x(row, j),
                  2.0 * alone.response(part.coordinates[i], j));
    }
  }
}

TEST(MechanismLanes, AgreeWithOneAloneWithinItsErrors) {
  std::mt19937_64 random(1);
  size_t reduced = 0, of = 0;
  for (size_t n = 3; n <= 12; ++n) {
    for (int round = 0; round < 20; ++round) {
      std::vector<int32_t> kept;
      for (size_t k = 3; k < n; ++k) {
        if (random() % 4 == 0) kept.push_back(static_cast<int32_t>(k));
      }
      std::vector<Mechanism> mechanisms;
      while (mechanisms.size() < kStates) {
        mechanisms.push_back(RandomMechanism(n, std::pow(10.0, static_cast<double>(random() % 11)), random));
        mechanisms.back().kept_coordinates = kept;
      }
      std::vector<double> responses;
      const std::vector<MechanismState> states = Reduced(mechanisms, responses);
      of += kStates;
      for (size_t i = 0; i < kStates; ++i) {
        if (!states[i].is_reduced) continue;
        ++reduced;
        ExpectWithinTwiceTheErrors(states[i], mechanisms[i]);
      }
    }
  }
  EXPECT_GT(reduced, of / 2);
}

TEST(MechanismLanes, LeaveWhatIsIrregularAndNoLaneDisturbsAnother) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  std::mt19937_64 random(2);
  std::vector<Mechanism> regular;
  while (regular.size() < 8) regular.push_back(RandomMechanism(4, 10.0, random));
  std::vector<Mechanism> mechanisms = regular;
  mechanisms[0].mass_matrix[1] *= 1.0 + 0x1p-50;  // Not symmetric.
  mechanisms[1].mass_matrix[5] = -1.0;
  mechanisms[2].mass_matrix[1] = mechanisms[2].mass_matrix[4] =
      2.0 * std::sqrt(mechanisms[2].mass_matrix[0] * mechanisms[2].mass_matrix[5]);          // Indefinite.
  for (size_t k = 0; k < 4; ++k) mechanisms[3].jacobian[k] = mechanisms[3].jacobian[4 + k];  // W has rank 2.
  mechanisms[4].jacobian[3] = std::nan("");
  mechanisms[5].rates[3] = kInfinity;
  mechanisms[6].mass_matrix[0] = 1e-310;
  std::vector<double> responses, of_regular;
  const std::vector<MechanismState> states = Reduced(mechanisms, responses);
  const std::vector<MechanismState> expected = Reduced(regular, of_regular);
  for (size_t i = 0; i < 8; ++i) {
    EXPECT_TRUE(expected[i].is_reduced) << i;
    EXPECT_EQ(states[i].is_reduced, i == 7) << i;
  }
  EXPECT_EQ(states[7].w, expected[7].w);
  EXPECT_EQ(states[7].velocity, expected[7].velocity);
}

TEST(MechanismLanes, LeaveMechanismsOfManyCoordinates) {
  std::mt19937_64 random(3);
  std::vector<double> responses;
  EXPECT_TRUE(Reduced({RandomMechanism(kMostInLanes, 10.0, random)}, responses).front().is_reduced);
  EXPECT_FALSE(Reduced({RandomMechanism(kMostInLanes + 1, 10.0, random)}, responses).front().is_reduced);
}

}  // namespace
}  // namespace ricochet
