// Finite duration: an impact in a plane in time, with real stiffness and the finite forces that act meanwhile.
//
//   d(u, v)/dt = W (F, N) + (a_t, a_n),   d' = -v,   d(0) = 0
//
// W as in core/models/planar/planar.h, held constant; (a_t, a_n) is the acceleration that gravity and other finite forces
// alone would give the contact.
//
//   linear          N = k d            k in N/m
//   Hertz           N = k d^(3/2)      k in N/m^(3/2)
//     unloading from the largest indentation d_max: N(d) = N_load((d - (1 - eta^2) d_max)/eta^2), loading again along the
//     same curve until d passes d_max; the work of restitution is -eta^2 that of compression whatever the path
//   Hunt-Crossley   N = k d^p (1 + c d')   no coefficient of restitution: the damping stands for it, and what it comes
//     to is reported. The impact ends where N = 0, and d > 0 there if a_n pulls the bodies apart; what the spring still
//     holds is lost.
//
// Tangentially rigid (Coulomb): F = -mu sgn(u) N while the contact slips; while it sticks F = -(Wtn N + a_t)/Wtt, as
// long as |F| <= mu_s N. Then slip starts towards sgn(Wtn N + a_t); so it does at first touch, where N = 0, from u0 = 0
// if a_t != 0. Wtt = 0: no friction. Linear with `ratio_squared`: a massless particle between body and surface on a
// tangential spring of stiffness k/ratio^2 (Stronge), F = -mu N s while it slides towards s, at the speed
// S = s u + mu ratio^2 kn/k v, kn the slope of N(d); F' = -(k/ratio^2) u while it sticks, as long as |F| <= mu N. It
// sticks at first touch if |u0| < mu ratio^2 |v0|; where S = 0 on the cone dS/dt decides. eta = 0 there needs
// mu |Wtn| < Wnn.
//
// Ends: N = 0. eta = 0, or eta^2 below the smallest normal double, which counts as 0: where v = 0 at d_max, all that
// the springs hold is lost. Where friction and the spring hold the contact at rest at the end of compression (rank one,
// locked): there. An impact that does not part within a budget of 50 000 steps or 200 changes of the sign of v, or
// provably never does, or that is lost in rounding, is answered with the state reached, regime wedged, converged =
// false and an infinite error:
// forces that press too hard, wedges. Nor may a contact whose particle sticks and slides too often (ratio below some
// 1e-3), or one at the brink of jamming under forces, end within it.
//
// Phases: normal and tangential works of compression are those of first loading, those of restitution all others.
// tau_compression and f_compression are the impulses at the last v = 0 with d = d_max. For Hunt-Crossley, whose curve
// is one, the works of compression are those up to there.
//
// Regimes as in core/models/planar/planar.h, by the first stop of slip, or of the particle, and by v there; v = 0 counts as
// restitution. Without forces and tangential spring the impact is planar::Solve's with the energetic law, at any k.
//
// Events: start; slip stops (u = 0; it sticks or reverses, as the regime says for the first); stick starts (of the
// particle); slip starts (after stick); compression ends (once, the last v = 0 with d = d_max); restitution ends.
//
// Method: natural units, so that tolerances mean the same at all sizes (core/models/finite_duration/motion.h), CVODE's
// Adams formulas of variable order, root finding for events. Peaks are taken at the events where they occur.
// Accuracy: velocities within `tolerance`, or as far as double precision has it (some 1e-12 without forces; close to
// rank one with a tangential spring 1e-15 Wtt Wnn/det W); error_estimate says what was reached. It is a multiple of the
// sum of the sizes of CVODE's local errors, calibrated: testing has not found it below the true error, and in the
// median it is 10 to 100 times that. All else has errors of like relative size, but for what passes close to 0.
// The same bits on one machine only: SUNDIALS calls the C library's pow.
// Bad input: none gets here (core/scene/validate.h). v0 >= 0: nothing changes, whatever the forces.

#ifndef RICOCHET_CORE_MODELS_FINITE_DURATION_FINITE_DURATION_H_
#define RICOCHET_CORE_MODELS_FINITE_DURATION_FINITE_DURATION_H_

#include <cstdint>
#include <optional>
#include <vector>

#include "core/models/impact_end.h"
#include "ricochet/outcome.h"
#include "ricochet/scene.h"

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

// No limit is ever broken: no spring here gives back more than it stored, the contact's forces only take energy. The
// excess is free of cancellation. The change of energy is what the contact's forces do:
// P.(v- + v+)/2 + a.(T P/2 - integral of P dt), P = (f1, tau1), T the duration.
struct Impact : ImpactEnd<double> {
  double f_compression = 0.0;
  double friction_dissipation = 0.0;  // >= 0
  double spring_energy = 0.0;         // Left in the tangential spring, and lost, >= 0.
  double error_estimate = 0.0;        // Of the velocities over max(|u0|, |v0|).
  bool converged = true;              // False: a budget ran out or the bodies do not part; the error is infinite.
  int64_t steps = 0;
  int64_t right_hand_sides = 0;
  ContactDuration contact;    // Duration, peaks, history.
  std::vector<Event> events;  // Contact alone: no rates.
};

Impact Solve(const Problem& problem);

}  // namespace ricochet::finite_duration

#endif  // RICOCHET_CORE_MODELS_FINITE_DURATION_FINITE_DURATION_H_
