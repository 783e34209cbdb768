#include "tests/contract/solvers.h"

#include <gtest/gtest.h>

#include <chrono>
#include <utility>

#include "core/models/restitution_law.h"
#include "ricochet/client.h"
#include "ricochet/solver.h"
#include "tests/support/processes/server_process.h"

namespace ricochet {

const Solver& Local() {
  static const LocalSolver solver;
  return solver;
}

const Solver& Remote() {
  static const ServerProcess server;
  static const Client client =
      Client::Connect({.target = server.address(), .deadline = std::chrono::minutes(1)}).value();
  return client;
}

Scene MakeScene(const pendulum::Problem& problem) {
  Scene scene;
  scene.system = Pendulum{problem.inertia, problem.a, problem.b, problem.omega_minus};
  scene.friction.kinetic_coefficient = problem.mu;
  if (problem.mu_static != problem.mu) scene.friction.static_coefficient = problem.mu_static;
  scene.restitution = ToRestitution(problem.law, problem.coefficient);
  return scene;
}

Scene PaperScene() {
  Scene scene;
  scene.system = Pendulum{.inertia_kg_m2 = 1.0, .a_m = 0.3, .b_m = 1.0, .omega_minus_rad_s = -1.0};
  scene.friction.kinetic_coefficient = 0.1;
  scene.restitution = EnergeticCoefficient{1.0};
  return scene;
}

std::vector<absl::StatusOr<SweepChunk>> Collect(SweepStream stream) {
  std::vector<absl::StatusOr<SweepChunk>> chunks;
  for (absl::StatusOr<SweepChunk>& chunk : stream) chunks.push_back(std::move(chunk));
  return chunks;
}

void ExpectSameStatus(const absl::Status& one, const absl::Status& other) {
  EXPECT_EQ(one.code(), other.code()) << one << " / " << other;
  EXPECT_EQ(one.message(), other.message());
  EXPECT_EQ(ReasonOf(one), ReasonOf(other));
  EXPECT_EQ(ViolationsOf(one), ViolationsOf(other));
}

}  // namespace ricochet
