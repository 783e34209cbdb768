#include "core/contact/moved_contact.h"

#include <Eigen/Core>
#include <cmath>
#include <cstddef>
#include <variant>
#include <vector>

#include "core/base/invariant.h"
#include "core/contact/linkage_matrices.h"
#include "core/contact/reduction.h"
#include "ricochet/system.h"

namespace ricochet {
namespace {

// Sets the rates of a system.
struct Mover {
  absl::Span<const double> rates;

  void operator()(Pendulum& pendulum) const { pendulum.omega_minus_rad_s = rates[0]; }
  void operator()(Linkage& linkage) const {
    for (size_t i = 0; i < linkage.links.size(); ++i) linkage.links[i].rate_rad_s = rates[i];
  }
  void operator()(Mechanism& mechanism) const { mechanism.rates.assign(rates.begin(), rates.end()); }
  void operator()(PlanarBody& body) const {
    body.velocity_t_m_s = rates[0];
    body.velocity_n_m_s = rates[1];
    body.rate_rad_s = rates[2];
  }
  void operator()(SpatialBody& body) const {
    body.linear_m_s.assign(rates.begin(), rates.begin() + 3);
    body.angular_rad_s.assign(rates.begin() + 3, rates.end());
  }
  void operator()(BodyPair& pair) const { std::visit(*this, pair.bodies); }
  template <typename Bodies>
  requires requires(Bodies& bodies) { bodies.body_1; }
  void operator()(Bodies& bodies) const {
    const size_t half = rates.size() / 2;
    Mover{rates.first(half)}(bodies.body_1);
    Mover{rates.subspan(half)}(bodies.body_2);
  }
  template <typename Other>
  void operator()(Other& /*system*/) const {
    CheckInvariant(false, "the system has rates that tell the velocity of its contact");
  }
};

// Adds the magnitudes of the terms of the contact's velocity, what each rate of a system adds to it.
struct TermSizes {
  absl::Span<const double> rates;
  ContactVelocity& size;

  void operator()(const Pendulum& pendulum) const {
    size.tangential_m_s[0] += std::fabs(pendulum.b_m * rates[0]);
    size.normal_m_s += std::fabs(pendulum.a_m * rates[0]);
  }
  void operator()(const Linkage& linkage) const {
    const Eigen::MatrixXd jacobian = TransposedJacobian(linkage);
    for (Eigen::Index k = 0; k < jacobian.rows(); ++k) {
      const double rate = rates[static_cast<size_t>(k)];
      size.tangential_m_s[0] += std::fabs(jacobian(k, 0) * rate);
      size.normal_m_s += std::fabs(jacobian(k, 1) * rate);
    }
  }
  void operator()(const Mechanism& mechanism) const {
    for (size_t i = 0; i < mechanism.jacobian.size(); ++i) {
      const size_t row = i / rates.size();
      double& along = row < size.tangential_m_s.size() ? size.tangential_m_s[row] : size.normal_m_s;
      along += std::fabs(mechanism.jacobian[i] * rates[i % rates.size()]);
    }
  }
  void operator()(const PlanarBody& body) const {
    size.tangential_m_s[0] += std::fabs(rates[0]) + std::fabs(rates[2] * body.offset_n_m);
    size.normal_m_s += std::fabs(rates[1]) + std::fabs(rates[2] * body.offset_t_m);
  }
  void operator()(const SpatialBody& body) const {
    const auto turned = [&](size_t i, size_t j) { return std::fabs(rates[3 + i] * body.offset_m[j]); };
    size.tangential_m_s[0] += std::fabs(rates[0]) + turned(1, 2) + turned(2, 1);
    size.tangential_m_s[1] += std::fabs(rates[1]) + turned(2, 0) + turned(0, 2);
    size.normal_m_s += std::fabs(rates[2]) + turned(0, 1) + turned(1, 0);
  }
  void operator()(const BodyPair& pair) const { std::visit(*this, pair.bodies); }
  template <typename Bodies>
  requires requires(Bodies& bodies) { bodies.body_1; }
  void operator()(const Bodies& bodies) const {
    const size_t half = rates.size() / 2;
    TermSizes{rates.first(half), size}(bodies.body_1);
    TermSizes{rates.subspan(half), size}(bodies.body_2);
  }
  template <typename Contact>
  void operator()(const Contact& /*without_rates*/) const {}
};

}  // namespace

ContactVelocity ContactVelocityAt(Scene scene, absl::Span<const double> rates) {
  std::visit(Mover{rates}, scene.system);
  return std::visit(
      [](const auto& reduction) {
        return ContactVelocity{{reduction.u0.begin(), reduction.u0.end()}, reduction.v0};
      },
      Reduce(scene));
}

ContactVelocity SizeOfTerms(const Scene& scene, absl::Span<const double> rates) {
  ContactVelocity size = {.tangential_m_s = Components(TangentialDirections(scene.system), 0.0)};
  if (const auto& surface = scene.surface_velocity; surface.has_value()) {
    const std::vector<double>& tangential = surface->tangential_m_s;
    for (size_t a = 0; a < tangential.size(); ++a) size.tangential_m_s[a] += std::fabs(tangential[a]);
    size.normal_m_s += std::fabs(surface->normal_m_s);
  }
  std::visit(TermSizes{rates, size}, scene.system);
  return size;
}

}  // namespace ricochet
