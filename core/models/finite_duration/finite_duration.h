// Finite duration: an impact in a plane in time, with real stiffness and the finite forces that act meanwhile.
//
//   d(u, v)/dt = W (F, N) + (a_t, a_n),   d' = -v,   d(0) = 0
//
// Solve integrates W, (u0, v0), friction, a normal spring (linear, Hertz, or Hunt and Crossley) and the acceleration
// (a_t, a_n) by finite forces, in SI units, with Runge-Kutta formulas of order 8. The contact is rigid along t, or a
// linear spring with the tangential compliance of Stronge's particle (core/models/compliant/compliant.h).
// Accuracy: velocities within `tolerance`, down to 1e-12 without forces and else as far as double precision has it;
// error_estimate says what was reached, and is above `tolerance` where that could not be met. Everything else has
// errors of like relative size, except near 0. An impact that does not end within its budgets is answered with the
// state reached: regime wedged, an infinite error, and the termination that says why. Bad input: none gets here
// (core/scene/validate.h). v0 >= 0: nothing changes, whatever the forces. Laws, ends, phases, units and accuracy:
// docs/theory/finite_duration.md.

#ifndef RICOCHET_CORE_MODELS_FINITE_DURATION_FINITE_DURATION_H_
#define RICOCHET_CORE_MODELS_FINITE_DURATION_FINITE_DURATION_H_

#include <cstdint>
#include <optional>
#include <vector>

#include "absl/functional/function_ref.h"
#include "core/models/impact_end.h"
#include "core/models/impact_errors.h"
#include "core/models/planar_problem.h"
#include "ricochet/outcome.h"
#include "ricochet/scene.h"

namespace ricochet::finite_duration {

// The law is energetic; `law` is not read. Hunt and Crossley's law does not read `coefficient` either.
struct Problem {
  PlanarProblem contact;
  double tangential_acceleration = 0.0;  // a_t, m/s^2
  double normal_acceleration = 0.0;      // a_n, m/s^2
  NormalSpring spring;                   // Set.
  std::optional<double> ratio_squared;   // Tangential over normal compliance, > 0; linear only. Unset: rigid along t.
  double tolerance = 1e-10;  // Error of the velocities after the impact over max(|u0|, |v0|), 1e-12 to 1e-1.
  int64_t intervals = 0;     // > 0: a history of so many equal steps of time.
};

struct TimedInstant : ImpactInstant<double> {
  double time_s = 0.0;  // Since first touch.
  friend bool operator==(const TimedInstant&, const TimedInstant&) = default;
};

// No limit is ever broken, because no spring here gives back more than it stored and the contact's forces only take
// energy. The excess is free of cancellation. The change of energy is the work of the contact's forces alone.
struct Impact : ImpactEnd<double> {
  double f_compression = 0.0;
  double friction_dissipation = 0.0;  // >= 0
  double spring_energy = 0.0;         // Lost with the tangential spring, >= 0.
  double error_estimate = 0.0;        // Error of the velocities over max(|u0|, |v0|).
  ImpactErrors errors;                // Impulses have none under finite forces or if W has rank one.
  bool stopped = false;               // The caller stopped the computation, and nothing else is known.
  int64_t steps = 0;
  int64_t right_hand_sides = 0;
  ContactDuration contact;  // Duration, peaks, history.
  std::vector<TimedInstant> events;
};

// Asks `stopped` every four steps, in about a millisecond at most, and ends soon after it says true.
Impact Solve(
    const Problem& problem, absl::FunctionRef<bool()> stopped = [] { return false; });

}  // namespace ricochet::finite_duration

#endif  // RICOCHET_CORE_MODELS_FINITE_DURATION_FINITE_DURATION_H_
