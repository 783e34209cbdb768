#include "core/multi/possible.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "core/multi/dual_bound.h"
#include "core/multi/dual_search.h"
#include "core/multi/faces.h"
#include "core/multi/orders.h"
#include "core/multi/springs.h"
#include "tests/support/scenes/multi_contact_vectors.h"
#include "tests/support/scenes/random_multi_contact.h"

namespace ricochet::multi {
namespace {

const auto kNever = [] { return false; };

std::vector<Eigen::VectorXd> ContactVelocities(const Problem& problem) {
  std::vector<Eigen::VectorXd> gammas;
  for (int j = 0; j < problem.v.size(); ++j) gammas.emplace_back(Eigen::VectorXd::Unit(problem.v.size(), j));
  return gammas;
}

std::vector<Range> RangesOf(const Problem& problem) {
  return FindPossible(problem, MetricOf(problem), PushApart(problem, MetricOf(problem)), ContactVelocities(problem),
                      kNever);
}

// The reference found them by faces in double precision, to about 1e-12.
TEST(PossibleTest, RangesOfTwoContactsAreThoseOfTheReference) {
  int scenes = 0;
  for (const auto& scene : ReadMultiContactVectors()) {
    if (!scene.contains("possible")) continue;
    ++scenes;
    const std::vector<Range> ranges = RangesOf(ProblemOf(scene));
    for (size_t j = 0; j < ranges.size(); ++j) {
      EXPECT_NEAR(ranges[j].lower, scene["possible"][j][0], 2e-12) << scene["id"];
      EXPECT_NEAR(ranges[j].upper, scene["possible"][j][1], 2e-12) << scene["id"];
    }
  }
  EXPECT_EQ(scenes, 36);
}

// Every impulse within the cones would add energy here, so that nothing can change.
TEST(PossibleTest, WhatPartsFasterThanItSlidesStaysAsItIs) {
  Problem problem = {.d = 3, .k = 2, .w = Eigen::MatrixXd::Identity(6, 6), .v = Vector::Zero(6)};
  problem.laws = {{.mu = 1.0, .e = 0.5}, {.mu = 0.2, .e = 0.5}};
  problem.w(2, 5) = problem.w(5, 2) = 0.5;
  problem.v << 0.9, 0.3, 1.0, 2.0, 1.0, 0.5;
  const std::vector<Range> ranges = RangesOf(problem);
  for (int j = 0; j < problem.v.size(); ++j) {
    const Range& range = ranges[static_cast<size_t>(j)];
    EXPECT_LE(range.lower, problem.v(j));
    EXPECT_GE(range.upper, problem.v(j));
    EXPECT_LT(range.upper - range.lower, 1e-14);
  }
}

TEST(PossibleTest, HoldEveryOutcomeOfOrdersAndSprings) {
  for (const auto& scene : ReadMultiContactVectors()) {
    const Problem problem = ProblemOf(scene);
    const std::vector<Range> ranges = RangesOf(problem);
    const auto expect_inside = [&](const Attained& attained) {
      for (int j = 0; j < problem.v.size(); ++j) {
        const Range& range = ranges[static_cast<size_t>(j)];
        EXPECT_GE(attained.v(j), range.lower - attained.ErrorOf(problem, j)) << scene["id"];
        EXPECT_LE(attained.v(j), range.upper + attained.ErrorOf(problem, j)) << scene["id"];
      }
    };
    for (const DistinctOutcome& outcome : FindOrders(problem, kNever).outcomes) expect_inside(outcome.attained);
    if (problem.d == 2) expect_inside(FindSprings(problem, std::nullopt, kNever));
  }
}

// The search knows nothing of faces.
TEST(PossibleTest, TheSearchProvesTheMaximaOfFaces) {
  std::mt19937_64 random(5);
  for (int scene = 0; scene < 40; ++scene) {
    const Problem problem = RandomMultiContact(random, false);
    const EnergyMetric metric = MetricOf(problem);
    const Eigen::VectorXd apart = PushApart(problem, MetricOf(problem));
    if (apart.size() == 0) continue;
    const std::vector<Eigen::VectorXd> gammas = ContactVelocities(problem);
    const std::vector<Maximum> maxima = MaximaOnFaces(problem, metric, gammas);
    for (size_t j = 0; j < gammas.size(); ++j) {
      const DualPoint point = MinimiseDual(problem, metric, apart, gammas[j], kNever);
      const double bound = DualBound(problem, metric.root_energy, apart, gammas[j], point);
      ASSERT_FALSE(maxima[2 * j].proofs.empty()) << scene;
      EXPECT_GE(bound, maxima[2 * j].value - 1e-12) << scene;
      EXPECT_LE(bound, maxima[2 * j].value + 1e-6) << scene;
    }
  }
}

// Random points of the set: impulses within the cones, shortened until energy does not rise.
TEST(PossibleTest, NoPointOfTheSetIsOutside) {
  std::mt19937_64 random(6);
  std::uniform_real_distribution<double> share(0.0, 1.0);
  int points = 0;
  for (int scene = 0; scene < 30; ++scene) {
    const Problem problem = RandomMultiContact(random, false);
    const std::vector<Range> ranges = RangesOf(problem);
    for (int sample = 0; sample < 2000; ++sample) {
      Eigen::VectorXd p(2 * problem.k);
      for (int i = 0; i < problem.k; ++i) {
        p(problem.N(i)) = share(random) < 0.3 ? 0.0 : share(random);
        p(problem.T(i)) = (2.0 * share(random) - 1.0) * problem.laws[static_cast<size_t>(i)].mu * p(problem.N(i));
      }
      const double square = p.dot(problem.w * p);
      const double most = square > 0.0 ? std::max(-2.0 * p.dot(problem.v) / square, 0.0) : 0.0;
      const Eigen::VectorXd v = problem.v + problem.w * p * (most * share(random));
      bool parts = true;
      for (int i = 0; i < problem.k; ++i) parts = parts && v(2 * i + 1) >= 0.0;
      if (!parts) continue;
      ++points;
      for (size_t j = 0; j < ranges.size(); ++j) {
        EXPECT_GE(v(static_cast<Eigen::Index>(j)), ranges[j].lower - 1e-13);
        EXPECT_LE(v(static_cast<Eigen::Index>(j)), ranges[j].upper + 1e-13);
      }
    }
  }
  EXPECT_GT(points, 3000);
}

// Break the dual point on purpose: a bound stays a bound, because pi is pushed back into its cone or left out.
TEST(DualBoundTest, AnyPointProvesABound) {
  std::mt19937_64 random(7);
  std::normal_distribution<double> normal;
  for (int scene = 0; scene < 40; ++scene) {
    const Problem problem = RandomMultiContact(random, false);
    const EnergyMetric metric = MetricOf(problem);
    const std::vector<Eigen::VectorXd> gammas = ContactVelocities(problem);
    const std::vector<Maximum> maxima = MaximaOnFaces(problem, metric, gammas);
    for (size_t j = 0; j < gammas.size(); ++j) {
      DualPoint point = {.nu = Eigen::VectorXd(problem.k), .pi = Eigen::VectorXd(2 * problem.k)};
      for (double& x : point.nu) x = normal(random);
      for (double& x : point.pi) x = normal(random);
      EXPECT_GE(DualBound(problem, metric.root_energy, PushApart(problem, MetricOf(problem)), gammas[j], point),
                maxima[2 * j].value - 1e-12);
    }
  }
}

// Two feet that stand side by side on one floor cannot press against each other, whatever friction holds them: a push
// upwards parts both.
TEST(PushApartTest, FeetOnOneFloorDoNotJamUnderAnyFriction) {
  // A block, 1 m wide and 2 m high, by x, y and its angle.
  Eigen::Matrix<double, 4, 3> jacobian;
  jacobian << 1.0, 0.0, 1.0, 0.0, 1.0, -0.5, 1.0, 0.0, 1.0, 0.0, 1.0, 0.5;
  const Eigen::Vector3d mobility(1.0, 1.0, 2.4);
  for (const double mu : {1.0, 1e3, 1e4, 1e6, 1e9, 1e12}) {
    Problem problem = {.d = 2,
                       .k = 2,
                       .w = jacobian * mobility.asDiagonal() * jacobian.transpose(),
                       .v = Vector::Zero(4),
                       .laws = {{.mu = mu}, {.mu = mu}}};
    const Eigen::VectorXd push = PushApart(problem, MetricOf(problem));
    ASSERT_EQ(push.size(), 4) << mu;
    const Eigen::VectorXd moved = problem.w * push;
    for (int i = 0; i < 2; ++i) EXPECT_GT(moved(problem.N(i)), mu * std::abs(moved(problem.T(i)))) << mu;
  }
}

// A wedge: two walls without friction that press a body between them.
TEST(PushApartTest, WallsThatFaceEachOtherJam) {
  Problem wedge = {.d = 2, .k = 2, .w = Eigen::MatrixXd::Zero(4, 4), .v = Vector::Zero(4), .laws = {{}, {}}};
  wedge.w(1, 1) = wedge.w(3, 3) = 1.0;
  wedge.w(1, 3) = wedge.w(3, 1) = -1.0;
  EXPECT_EQ(PushApart(wedge, MetricOf(wedge)).size(), 0);
  wedge.w(1, 3) = wedge.w(3, 1) = -0.999;
  EXPECT_EQ(PushApart(wedge, MetricOf(wedge)).size(), 4);
}

}  // namespace
}  // namespace ricochet::multi
