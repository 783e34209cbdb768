// ImpactEnd: the fields of a result that all models share. The template parameter `Tangential` is a double in the plane
// and std::array<double, 2> in space.

#ifndef RICOCHET_CORE_MODELS_IMPACT_END_H_
#define RICOCHET_CORE_MODELS_IMPACT_END_H_

#include <algorithm>
#include <limits>

#include "ricochet/outcome.h"

namespace ricochet {

template <typename Tangential>
struct ImpactEnd {
  Regime regime = Regime::kUnspecified;
  Termination termination = Termination::kConverged;
  int w_rank = 0;
  bool sharp_limit_broken = false;   // The implied energetic coefficient is above 1.
  bool energy_limit_broken = false;  // E+ > E-.
  // Friction does positive work. Coulomb's law at every instant never does; a model that lets slip reverse without
  // reversing friction may.
  bool friction_limit_broken = false;
  double newton = 0.0, poisson = 0.0, energetic = 0.0;
  double tangential = 0.0;        // |f1|/tau1, signed in a plane.
  double energetic_excess = 0.0;  // energetic - 1
  Tangential u1 = {};
  double v1 = 0.0;
  double tau_compression = 0.0, tau1 = 0.0;  // Normal impulses.
  Tangential f1 = {};                        // Tangential impulse.
  double work_normal_compression = 0.0, work_normal_restitution = 0.0;
  double work_tangential_compression = 0.0, work_tangential_restitution = 0.0;
  double energy_change = 0.0;  // E+ - E-

  bool Converged() const { return termination == Termination::kConverged; }
};

// The state of the contact at an event.
template <typename Tangential>
struct ImpactInstant {
  EventKind kind = EventKind::kUnspecified;
  double tau = 0.0;   // Normal impulse so far.
  Tangential f = {};  // Tangential impulse so far.
  Tangential u = {};
  double v = 0.0;
  friend bool operator==(const ImpactInstant&, const ImpactInstant&) = default;
};

// True if the impact has an event of this kind at a normal impulse of at most `tau`.
template <typename Impact>
bool HasEvent(const Impact& impact, EventKind kind, double tau = std::numeric_limits<double>::infinity()) {
  return std::any_of(impact.events.begin(), impact.events.begin() + impact.event_count,
                     [&](const auto& event) { return event.kind == kind && event.tau <= tau; });
}

// The result for a contact that does not approach, v0 >= 0: nothing changes.
template <typename Impact, typename Tangential>
Impact Separating(int w_rank, const Tangential& u0, double v0) {
  Impact impact;
  impact.regime = Regime::kSeparating;
  impact.w_rank = w_rank;
  impact.energetic_excess = -1.0;
  impact.u1 = u0;
  impact.v1 = v0;
  return impact;
}

}  // namespace ricochet

#endif  // RICOCHET_CORE_MODELS_IMPACT_END_H_
