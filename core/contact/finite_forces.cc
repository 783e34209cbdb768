#include "core/contact/finite_forces.h"

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <variant>

#include "core/contact/linkage_matrices.h"

namespace ricochet {
namespace {

void Add(const System& /*system*/, std::monostate /*none*/, PlanarReduction& /*reduction*/) {}

void Add(const System& system, const PinMoment& moment, PlanarReduction& reduction) {
  const auto& pendulum = std::get<Pendulum>(system);
  const double turn = moment.moment_n_m / pendulum.inertia_kg_m2;
  reduction.acceleration = {pendulum.b_m * turn, pendulum.a_m * turn};
  reduction.drift = {turn};
}

void Add(const System& /*system*/, const ContactAcceleration& acceleration, PlanarReduction& reduction) {
  reduction.acceleration = {acceleration.tangential_m_s2, acceleration.normal_m_s2};
}

void Add(const System& system, const Gravity& gravity, PlanarReduction& reduction) {
  if (const auto* linkage = std::get_if<Linkage>(&system)) {
    const Eigen::VectorXd turn = MassMatrix(*linkage).llt().solve(GravityMoments(*linkage, gravity));
    const Eigen::Vector2d contact = TransposedJacobian(*linkage).transpose() * turn;
    reduction.acceleration = {contact(0), contact(1)};
    reduction.drift.assign(turn.begin(), turn.end());
    return;
  }
  const bool is_pair = std::holds_alternative<BodyPair>(system);
  if (!is_pair) reduction.acceleration = {gravity.tangential_m_s2, gravity.normal_m_s2};
  for (int body = 0; body < (is_pair ? 2 : 1); ++body) {
    reduction.drift.insert(reduction.drift.end(), {gravity.tangential_m_s2, gravity.normal_m_s2, 0.0});
  }
}

}  // namespace

void AddFiniteForces(const Scene& scene, PlanarReduction& reduction) {
  std::visit([&](const auto& forces) { Add(scene.system, forces, reduction); }, scene.finite_forces);
}

}  // namespace ricochet
