// Planar: one frictional impact at one point of any planar system, event by event, exact: no step size.
//
// All that a multibody system knows of the impact is its contact-space inverse inertia (Delassus matrix)
// W = [Wtt, Wtn; Wtn, Wnn] = J M^-1 J^T, symmetric positive semidefinite, and the approach velocity (u0, v0), v0 < 0.
// Routh (1905), Keller (1986), Wang and Mason (1992); with the normal impulse tau as the independent variable:
//
//   d(u, v)/dtau = W (f', 1),   f' = -mu sgn(u) while the contact slips, |f'| <= mu_s while it sticks
//
// At u = 0 the contact sticks, f' = -Wtn/Wtt, if |Wtn| <= mu_s Wtt; else slip starts towards sgn(Wtn). u and v are
// piecewise linear in tau. Compression ends at v = 0. v may grow at first (self-locking): then compression goes on until
// slip has stopped. Restitution ends at
//   Newton     v = -e v0
//   Poisson    tau1 = (1 + k) tau_c
//   energetic  normal work of restitution = -eta^2 times that of compression
// Rank one (det W = 0 within 4 eps Wtt Wnn) and stick is locked: u and v vanish together, no restitution.

#ifndef RICOCHET_CORE_MODELS_PLANAR_H_
#define RICOCHET_CORE_MODELS_PLANAR_H_

#include <array>
#include <cstdint>

#include "core/models/pendulum.h"
#include "core/outcome.h"

namespace ricochet::planar {

using Law = pendulum::Law;

struct Problem {
  double wtt = 0.0;  // 1/kg, >= 0
  double wtn = 0.0;
  double wnn = 0.0;  // > 0
  double u0 = 0.0;   // m/s
  double v0 = 0.0;   // m/s; >= 0 is separating
  double mu = 0.0;
  double mu_static = 0.0;  // >= mu
  Law law = Law::kEnergetic;
  double coefficient = 0.0;
};

// The contact at an event, and what ends or begins there.
struct Instant {
  EventKind kind = EventKind::kUnspecified;
  double tau = 0.0;  // Normal impulse so far.
  double f = 0.0;    // Tangential impulse so far.
  double u = 0.0;
  double v = 0.0;
};

struct Impact {
  Regime regime = Regime::kUnspecified;
  int w_rank = 0;
  bool sharp_limit_broken = false;   // Implied energetic coefficient > 1.
  bool energy_limit_broken = false;  // E+ > E-.
  double newton = 0.0, poisson = 0.0, energetic = 0.0, tangential = 0.0;
  double energetic_excess = 0.0;  // energetic - 1, free of cancellation
  double u1 = 0.0, v1 = 0.0;
  double tau_compression = 0.0, tau1 = 0.0, f1 = 0.0;
  double work_normal_compression = 0.0, work_normal_restitution = 0.0;
  double work_tangential_compression = 0.0, work_tangential_restitution = 0.0;
  double energy_change = 0.0;  // p . (v- + v+)/2, never through an inverse of W
  std::array<Instant, 8> events;
  int event_count = 0;
};

Impact Solve(const Problem& problem);

}  // namespace ricochet::planar

#endif  // RICOCHET_CORE_MODELS_PLANAR_H_
