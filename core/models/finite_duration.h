// Finite duration: an impact in a plane in time, with real stiffness and the finite forces that act meanwhile.
//
//   d(u, v)/dt = W (F, N) + (a_t, a_n),   d' = -v,   d(0) = 0
//
// W as in core/models/planar.h, held constant; (a_t, a_n) is the acceleration that gravity and other finite forces
// alone would give the contact. F = -mu sgn(u) N while the contact slips, |F| <= mu_s N while it sticks.
//
//   linear          N = k d            k in N/m
//   Hertz           N = k d^(3/2)      k in N/m^(3/2)
//     unloading from the largest indentation d_max: N(d) = N_load((d - (1 - eta^2) d_max)/eta^2)
//   Hunt-Crossley   N = k d^p (1 + c d')   no coefficient of restitution: the damping stands for it

#ifndef RICOCHET_CORE_MODELS_FINITE_DURATION_H_
#define RICOCHET_CORE_MODELS_FINITE_DURATION_H_

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "core/outcome.h"
#include "core/scene/scene.h"

namespace ricochet::finite_duration {

struct Problem {
  double wtt = 0.0;  // 1/kg, >= 0
  double wtn = 0.0;
  double wnn = 0.0;                      // > 0
  double u0 = 0.0;                       // m/s
  double v0 = 0.0;                       // m/s; >= 0 is separating
  double tangential_acceleration = 0.0;  // a_t, m/s^2
  double normal_acceleration = 0.0;      // a_n, m/s^2
  double mu = 0.0;
  double mu_static = 0.0;               // >= mu
  NormalSpring spring;                  // Set.
  double energetic = 0.0;               // eta in [0, 1]; not used by Hunt-Crossley.
  std::optional<double> ratio_squared;  // Tangential over normal compliance, > 0; linear only. Unset: rigid along t.
  double tolerance = 1e-10;             // Of each velocity after the impact over max(|u0|, |v0|); in [1e-12, 1e-1].
  int64_t intervals = 0;                // > 0: a history of so many equal steps of time.
};

struct Impact {
  Regime regime = Regime::kUnspecified;
  int w_rank = 0;
  bool sharp_limit_broken = false;
  bool energy_limit_broken = false;
  double newton = 0.0, poisson = 0.0, energetic = 0.0;
  double tangential = 0.0;  // f1/tau1
  double energetic_excess = 0.0;
  double u1 = 0.0, v1 = 0.0;
  double tau_compression = 0.0, tau1 = 0.0;
  double f_compression = 0.0, f1 = 0.0;
  double work_normal_compression = 0.0, work_normal_restitution = 0.0;
  double work_tangential_compression = 0.0, work_tangential_restitution = 0.0;
  // What the contact's forces do: P.(v- + v+)/2 + a.(T P/2 - integral of P dt), P = (f1, tau1), T the duration.
  double energy_change = 0.0;
  double friction_dissipation = 0.0;  // >= 0
  double spring_energy = 0.0;         // Left in the tangential spring, and lost, >= 0.
  double error_estimate = 0.0;        // Of the velocities over max(|u0|, |v0|).
  bool converged = true;              // False: a budget ran out or the bodies do not part; the error is infinite.
  int64_t steps = 0;
  int64_t right_hand_sides = 0;
  ContactDuration contact;    // Duration, peaks, history.
  std::vector<Event> events;  // Contact alone: no rates.
};

// Has the same bits on one machine only: SUNDIALS.
Impact Solve(const Problem& problem);

}  // namespace ricochet::finite_duration

#endif  // RICOCHET_CORE_MODELS_FINITE_DURATION_H_
