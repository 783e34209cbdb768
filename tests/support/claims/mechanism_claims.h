// Random mechanisms on which the errors of rates_after and momentum_change are held to what they claim.
//
// M = Q D Q^T with a random orthogonal Q and the condition asked for; J and q' are random. The reference takes the
// doubles of M, J and q' as exact: it eliminates in ball arithmetic and follows the impact with the oracles of the
// planar and the spatial model. Errors are relative to the largest rate before or after.

#ifndef RICOCHET_TESTS_SUPPORT_CLAIMS_MECHANISM_CLAIMS_H_
#define RICOCHET_TESTS_SUPPORT_CLAIMS_MECHANISM_CLAIMS_H_

#include <Eigen/Core>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/answer/scene_outcome.h"
#include "core/contact/mechanism.h"
#include "core/models/planar/planar.h"
#include "core/models/spatial/spatial.h"
#include "core/plan/scene_problem.h"
#include "ricochet/eigen.h"
#include "tests/support/claims/claims.h"
#include "tests/support/oracles/planar_oracle.h"
#include "tests/support/oracles/spatial_oracle.h"
#include "tests/support/scenes/random_scenes.h"

namespace ricochet {

struct MechanismClaims {
  ClaimTally rates, momentum;
};

namespace mechanism_claims {

inline Ball Of(double x) { return Ball(x, 512); }

// M, condition up to 10^`decades`.
inline Eigen::MatrixXd MassOf(Eigen::Index n, double decades, RandomScenes& random) {
  Eigen::MatrixXd entries(n, n);
  for (double& entry : entries.reshaped()) entry = random.Uniform(-1.0, 1.0);
  const Eigen::MatrixXd q = Eigen::HouseholderQR<Eigen::MatrixXd>(entries).householderQ();
  Eigen::VectorXd eigenvalues(n);
  for (double& eigenvalue : eigenvalues) eigenvalue = random.Power(-decades, 0.0);
  Eigen::MatrixXd mass = q * eigenvalues.asDiagonal() * q.transpose();
  mass.triangularView<Eigen::StrictlyLower>() = mass.transpose();
  return mass;
}

// With `one_free`, all coordinates but one keep their rates.
inline Scene SceneAtRandom(bool in_space, double decades, bool one_free, RandomScenes& random) {
  const auto n = static_cast<Eigen::Index>(random.Uniform(in_space ? 3.0 : 2.0, 12.99));
  Eigen::MatrixXd jacobian(in_space ? 3 : 2, n);
  for (double& entry : jacobian.reshaped()) entry = random.Uniform(-1.0, 1.0);
  Eigen::VectorXd rates(n);
  for (double& rate : rates) rate = random.Uniform(-2.0, 2.0);
  if ((jacobian * rates)(in_space ? 2 : 1) > 0.0) rates = -rates;
  Mechanism mechanism = *MechanismFrom(MassOf(n, decades, random), jacobian, rates);
  if (one_free) {
    for (int i = 1; i < n; ++i) mechanism.kept_coordinates.push_back(i);
  } else if (n > 5 && random.OneIn(3)) {
    mechanism.kept_coordinates = {1, 4};
  }
  const double coefficient = random.Uniform(0.0, 1.0);
  const int law = static_cast<int>(random.Uniform(0.0, 2.999));
  return {.system = mechanism,
          .friction = {.kinetic_coefficient = random.Power(-2.0, 0.0)},
          .restitution = law == 0   ? Restitution(NewtonCoefficient{coefficient})
                         : law == 1 ? Restitution(PoissonCoefficient{coefficient})
                                    : Restitution(EnergeticCoefficient{coefficient})};
}

// The reduction in ball arithmetic, and X = M^-1 J^T with rows of 0 for coordinates that are held.
struct ExactReduction {
  std::vector<std::vector<Ball>> w, x;
  std::vector<Ball> velocity;
};

inline ExactReduction ReduceExactly(const Mechanism& mechanism) {
  const size_t n = mechanism.rates.size();
  const size_t directions = mechanism.jacobian.size() / n;
  const std::vector<Eigen::Index> free = FreeCoordinates(mechanism);
  const size_t size = free.size();
  std::vector<std::vector<Ball>> rows(size);  // M and J^T
  const auto at = [&](size_t i) { return static_cast<size_t>(free[i]); };
  for (size_t i = 0; i < size; ++i) {
    for (size_t j = 0; j < size; ++j) rows[i].push_back(Of(mechanism.mass_matrix[at(i) * n + at(j)]));
    for (size_t d = 0; d < directions; ++d) rows[i].push_back(Of(mechanism.jacobian[d * n + at(i)]));
  }
  for (size_t pivot = 0; pivot < size; ++pivot) {
    for (size_t i = 0; i < size; ++i) {
      if (i == pivot) continue;
      const Ball factor = rows[i][pivot] / rows[pivot][pivot];
      for (size_t k = pivot; k < size + directions; ++k) rows[i][k] = rows[i][k] - factor * rows[pivot][k];
    }
  }
  ExactReduction exact;
  exact.x.assign(n, std::vector<Ball>(directions, Of(0.0)));
  for (size_t i = 0; i < size; ++i) {
    for (size_t d = 0; d < directions; ++d) exact.x[at(i)][d] = rows[i][size + d] / rows[i][i];
  }
  exact.w.assign(directions, std::vector<Ball>(directions, Of(0.0)));
  exact.velocity.assign(directions, Of(0.0));
  for (size_t i = 0; i < directions; ++i) {
    for (size_t k = 0; k < n; ++k) {
      const Ball entry = Of(mechanism.jacobian[i * n + k]);
      exact.velocity[i] = exact.velocity[i] + entry * Of(mechanism.rates[k]);
      for (size_t j = 0; j < directions; ++j) exact.w[i][j] = exact.w[i][j] + entry * exact.x[k][j];
    }
  }
  return exact;
}

// The impulses; nothing where the oracle does not serve.
inline std::optional<std::vector<Ball>> ImpulsesOf(const Scene& scene, const SceneContact& contact,
                                                   const ExactReduction& exact) {
  if (const auto* planar = std::get_if<PlanarReduction>(&contact.reduction)) {
    const planar::ExactImpact impact =
        planar::SolveExactly(planar::MakeProblem(*planar, scene.restitution, contact.coefficients),
                             {exact.w[0][0], exact.w[0][1], exact.w[1][1], exact.velocity[0], exact.velocity[1]});
    return std::vector<Ball>{impact.end().f, impact.end().tau};
  }
  const auto problem = spatial::MakeProblem(std::get<SpatialReduction>(contact.reduction), scene.restitution,
                                            contact.coefficients, 1e-12);
  const auto impact = spatial::SolveExactly(
      problem, {.w = {exact.w[0][0], exact.w[0][1], exact.w[0][2], exact.w[1][1], exact.w[1][2], exact.w[2][2]},
                .u0 = {exact.velocity[0], exact.velocity[1]},
                .v0 = exact.velocity[2]});
  if (!impact.has_value()) return std::nullopt;
  return std::vector<Ball>{impact->f1[0], impact->f1[1], impact->tau1};
}

inline void AddTo(const Scene& scene, const std::string& name, MechanismClaims& claims) {
  const auto& mechanism = std::get<Mechanism>(scene.system);
  std::optional<SceneContact> contact(std::in_place, scene);
  Outcome outcome;
  const absl::Status solved = SolveScene(
      scene, contact, Demand(), {}, [] { return false; }, outcome);
  if (!solved.ok() || outcome.regime == Regime::kSeparating || outcome.termination == Termination::kRefused) return;
  const ExactReduction exact = ReduceExactly(mechanism);
  const std::optional<std::vector<Ball>> impulses = ImpulsesOf(scene, *contact, exact);
  if (!impulses.has_value()) return;
  const size_t n = mechanism.rates.size();
  std::vector<Ball> change(n, Of(0.0));
  double scale = 0.0;
  for (size_t i = 0; i < n; ++i) {
    for (size_t d = 0; d < impulses->size(); ++d) change[i] = change[i] + exact.x[i][d] * (*impulses)[d];
    scale = std::max({scale, std::fabs(mechanism.rates[i]), std::fabs(outcome.rates_after[i])});
  }
  for (size_t i = 0; i < n; ++i) {
    const Ball after = Of(mechanism.rates[i]) + change[i];
    Ball momentum = Of(0.0);
    double most = 1e-300;
    for (size_t k = 0; k < n; ++k) momentum = momentum + Of(mechanism.mass_matrix[i * n + k]) * change[k];
    most = std::max(most, std::fabs(outcome.momentum_change[i]));
    const auto error = [](double found, const Ball& of) { return Abs(Of(found) - of).UpperBound(); };
    const std::string entry = name + ", coordinate " + std::to_string(i);
    claims.rates.Add(outcome.errors.rates_after[i] / scale, error(outcome.rates_after[i], after) / scale, entry);
    claims.momentum.Add(outcome.errors.momentum_change[i] / most, error(outcome.momentum_change[i], momentum) / most,
                        entry);
  }
}

}  // namespace mechanism_claims

// `hard` mechanisms have a condition up to 10^10, others up to 10^3.
inline MechanismClaims MechanismClaimsOf(bool in_space, bool hard, int count, uint64_t seed, bool one_free = false) {
  RandomScenes random(seed);
  MechanismClaims claims;
  for (int i = 0; i < count; ++i) {
    const Scene scene = mechanism_claims::SceneAtRandom(in_space, hard ? 10.0 : 3.0, one_free, random);
    mechanism_claims::AddTo(scene, "scene " + std::to_string(i), claims);
  }
  return claims;
}

}  // namespace ricochet

#endif  // RICOCHET_TESTS_SUPPORT_CLAIMS_MECHANISM_CLAIMS_H_
