#include "core/contact/moved_contact.h"

#include <array>
#include <cmath>
#include <cstddef>
#include <variant>
#include <vector>

#include "core/base/invariant.h"
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

void AddSize(absl::Span<const double> tangential, double normal, ContactVelocity& size) {
  for (size_t a = 0; a < tangential.size(); ++a) size.tangential_m_s[a] += std::fabs(tangential[a]);
  size.normal_m_s += std::fabs(normal);
}

}  // namespace

ContactVelocity ContactVelocityAt(Scene scene, absl::Span<const double> rates) {
  std::visit(Mover{rates}, scene.system);
  return std::visit(
      [](const auto& reduction) {
        return ContactVelocity{{reduction.u0.begin(), reduction.u0.end()}, reduction.v0};
      },
      Reduce(scene));
}

ContactVelocity SizeOfTerms(Scene scene, absl::Span<const double> rates) {
  const size_t tangential = TangentialDirections(scene.system);
  ContactVelocity size = {.tangential_m_s = Components(tangential, 0.0)};
  if (const auto& surface = scene.surface_velocity; surface.has_value()) {
    AddSize(surface->tangential_m_s, surface->normal_m_s, size);
    scene.surface_velocity.reset();
  }
  std::vector<double> one(rates.size());
  const auto* const mechanism = std::get_if<Mechanism>(&scene.system);
  for (size_t k = 0; k < rates.size(); ++k) {
    if (mechanism != nullptr) {
      const auto term = [&](size_t row) { return mechanism->jacobian[row * rates.size() + k] * rates[k]; };
      const std::array<double, 2> along = {term(0), tangential > 1 ? term(1) : 0.0};
      AddSize(absl::MakeSpan(along).first(tangential), term(tangential), size);
      continue;
    }
    one[k] = rates[k];
    const ContactVelocity term = ContactVelocityAt(scene, one);
    AddSize(term.tangential_m_s, term.normal_m_s, size);
    one[k] = 0.0;
  }
  return size;
}

}  // namespace ricochet
