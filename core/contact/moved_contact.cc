#include "core/contact/moved_contact.h"

#include <cstddef>
#include <variant>

#include "core/base/invariant.h"
#include "core/contact/reduction.h"

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

}  // namespace

ContactVelocity ContactVelocityAt(Scene scene, absl::Span<const double> rates) {
  std::visit(Mover{rates}, scene.system);
  return std::visit(
      [](const auto& reduction) {
        return ContactVelocity{{reduction.u0.begin(), reduction.u0.end()}, reduction.v0};
      },
      Reduce(scene));
}

}  // namespace ricochet
