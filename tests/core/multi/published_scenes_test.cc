// The scenes of Halm and Posa, "Set-Valued Rigid Body Dynamics for Simultaneous, Inelastic, Frictional Impacts"
// (arXiv 2103.15714): their outcomes, sampled here, lie in the outer set.

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "core/multi/dual_bound.h"
#include "core/multi/energy.h"
#include "core/multi/possible.h"

namespace ricochet::multi {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;

// The contacts of a system: M, the rates before, and for each contact a row along t and one along n.
Problem ProblemOf(const Eigen::MatrixXd& mass, const Eigen::MatrixXd& jacobian, const Eigen::VectorXd& rates,
                  double friction) {
  const auto k = static_cast<int>(jacobian.rows() / 2);
  return {.d = 2,
          .k = k,
          .w = jacobian * mass.llt().solve(jacobian.transpose()),
          .v = jacobian * rates,
          .laws = std::vector<ContactLaw>(static_cast<size_t>(k), {.mu = friction})};
}

// A box of 1 kg, 1 m wide and high, slides over the floor with one corner and strikes a wall with another.
Problem BoxAtWall() {
  const Eigen::Matrix2d turn = Eigen::Rotation2Dd(80.0 * kDegree).toRotationMatrix();
  Eigen::Vector2d lowest(0.0, 1.0), rightmost(-1.0, 0.0);
  for (const double x : {-0.5, 0.5}) {
    for (const double y : {-0.5, 0.5}) {
      const Eigen::Vector2d corner = turn * Eigen::Vector2d(x, y);
      if (corner.y() < lowest.y()) lowest = corner;
      if (corner.x() > rightmost.x()) rightmost = corner;
    }
  }
  Eigen::MatrixXd jacobian(4, 3);
  jacobian << 1, 0, -lowest.y(), 0, 1, lowest.x(),  // The floor: t along x.
      0, 1, rightmost.x(), -1, 0, rightmost.y();    // The wall: n along -x, t along y.
  return ProblemOf(Eigen::Vector3d(1.0, 1.0, 1.0 / 6.0).asDiagonal(), jacobian, Eigen::Vector3d(1.0, 0.0, 0.0), 1.0);
}

// A phone falls flat from a height of 1 mm.
Problem FallingPhone() {
  const double width = 0.07444, height = 0.16094, mass = 0.19;
  const double inertia = mass * (width * width + height * height) / 12.0;
  Eigen::MatrixXd jacobian(4, 3);
  jacobian << 1, 0, height / 2, 0, 1, -width / 2, 1, 0, height / 2, 0, 1, width / 2;
  const Eigen::Vector3d rates(0.0, -std::sqrt(2.0 * 9.81 * 0.001), 0.0);
  return ProblemOf(Eigen::Vector3d(mass, mass, inertia).asDiagonal(), jacobian, rates, 1.0);
}

// A compass gait whose legs span 156 degrees: one foot stands, the other lands. Each leg has 1 kg at its middle.
Problem CompassGait() {
  const double spin = 0.5;
  Eigen::MatrixXd mass = Eigen::MatrixXd::Zero(4, 4), jacobian(4, 4);
  for (const int leg : {0, 1}) {
    const double angle = (leg == 0 ? -78.0 : 78.0) * kDegree;
    const auto point = [&](double distance) {
      Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(2, 4);
      rows(0, 0) = rows(1, 1) = 1.0;
      rows(0, 2 + leg) = distance * std::cos(angle);
      rows(1, 2 + leg) = distance * std::sin(angle);
      return rows;
    };
    mass += point(0.5).transpose() * point(0.5);
    jacobian.middleRows(2 * leg, 2) = point(1.0);
  }
  const double angle = 78.0 * kDegree;
  return ProblemOf(mass, jacobian, Eigen::Vector4d(-std::cos(angle) * spin, -std::sin(angle) * spin, spin, spin), 5.0);
}

// A disc falls between two that touch each other and the floor. Each has the radius 1 m and 5 kg.
Problem StackOfDiscs() {
  const Eigen::Vector2d centres[] = {{1.0, 1.0 + std::sqrt(3.0)}, {0.0, 1.0}, {2.0, 1.0}};
  Eigen::MatrixXd mass = Eigen::MatrixXd::Identity(9, 9) * 5.0;
  for (const int disc : {0, 1, 2}) mass(3 * disc + 2, 3 * disc + 2) = 2.5;
  Eigen::MatrixXd jacobian = Eigen::MatrixXd::Zero(10, 9);
  int row = 0;
  // The velocity of `disc` relative to `other`, or to the floor.
  const auto touch = [&](int disc, int other, const Eigen::Vector2d& normal) {
    const Eigen::Vector2d tangent(normal.y(), -normal.x());
    for (const Eigen::Vector2d& direction : {tangent, normal}) {
      const auto add = [&](int of, double sign, const Eigen::Vector2d& arm) {
        jacobian.block(row, 3 * of, 1, 2) += sign * direction.transpose();
        jacobian(row, 3 * of + 2) += sign * (arm.x() * direction.y() - arm.y() * direction.x());
      };
      add(disc, 1.0, -normal);
      if (other >= 0) add(other, -1.0, normal);
      ++row;
    }
  };
  for (const int disc : {1, 2}) touch(disc, -1, {0.0, 1.0});
  for (const int disc : {1, 2}) touch(0, disc, (centres[0] - centres[disc]) / 2.0);
  touch(2, 1, {1.0, 0.0});
  Eigen::VectorXd rates = Eigen::VectorXd::Zero(9);
  rates(1) = -1.0;
  return ProblemOf(mass, jacobian, rates, std::sqrt(3.0));
}

// One end of the inclusion: contacts that approach are pressed in ratios that change at random, and friction opposes
// slip, until none approaches.
Vector RandomOutcome(const Problem& problem, std::mt19937_64& random, double step) {
  constexpr int kSteps = 400;  // In one ratio.
  std::exponential_distribution<double> exponential;
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  Vector v = problem.v;
  std::vector<double> weights(static_cast<size_t>(problem.k));
  for (int64_t count = 0; count < 1'000'000; ++count) {
    if (count % kSteps == 0) {
      for (double& weight : weights) weight = unit(random) < 0.5 ? 0.0 : exponential(random);
      weights[static_cast<size_t>(count / kSteps) % weights.size()] += 0.01;
    }
    bool approaches = false;
    Vector impulse = Vector::Zero(v.size());
    for (int i = 0; i < problem.k; ++i) {
      if (v(problem.N(i)) >= 0.0) continue;
      approaches = true;
      const double normal = step * weights[At(i)];
      const double stop = std::abs(v(problem.T(i))) / problem.w(problem.T(i), problem.T(i));
      const double friction = std::min(problem.laws[At(i)].mu * normal, stop);
      impulse(problem.N(i)) = normal;
      impulse(problem.T(i)) = std::copysign(friction, -v(problem.T(i)));
    }
    if (!approaches) break;
    v += problem.w * impulse;
  }
  return v;
}

TEST(PublishedScenesTest, OutcomesOfHalmAndPosaArePossible) {
  std::mt19937_64 random(11);
  int differ = 0;
  for (const Problem& problem : {BoxAtWall(), FallingPhone(), CompassGait(), StackOfDiscs()}) {
    std::vector<Eigen::VectorXd> gammas;
    for (int j = 0; j < problem.v.size(); ++j) gammas.emplace_back(Eigen::VectorXd::Unit(problem.v.size(), j));
    const std::vector<Range> ranges =
        FindPossible(problem, MetricOf(problem), PushApart(problem, MetricOf(problem)), gammas, [] { return false; });
    const double speed = problem.v.lpNorm<Eigen::Infinity>();
    const double step = 1e-3 * speed / problem.w.diagonal().maxCoeff();
    Vector lowest = Vector::Constant(problem.v.size(), 1e9), highest = -lowest;
    for (int sample = 0; sample < 1000; ++sample) {
      const Vector v = RandomOutcome(problem, random, step);
      lowest = lowest.cwiseMin(v);
      highest = highest.cwiseMax(v);
    }
    for (int j = 0; j < problem.v.size(); ++j) {
      const Range& range = ranges[static_cast<size_t>(j)];
      EXPECT_GE(lowest(j), range.lower - 0.01 * speed) << j;
      EXPECT_LE(highest(j), range.upper + 0.01 * speed) << j;
    }
    differ += (highest - lowest).maxCoeff() > 0.1 * speed ? 1 : 0;
  }
  EXPECT_EQ(differ, 3);  // The standing foot of the compass gait lifts off at once.
}

}  // namespace
}  // namespace ricochet::multi
