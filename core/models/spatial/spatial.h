// Spatial: one frictional impact at one point in space, slip that turns, stops, sticks and starts again.
//
// W is 3x3 (t1, t2, n), symmetric positive semidefinite; slip s = |(u1, u2)|, direction phi. With the normal impulse
// tau as the independent variable (Keller 1986) and e(phi) = (cos phi, sin phi), the components of
// -mu Wtt e(phi) + wtn along and across e(phi) are h(phi) and g(phi):
//
//   ds/dtau = h(phi),   s dphi/dtau = g(phi),   dv/dtau = Wnn - mu wtn . e(phi)
//
// It is singular as s -> 0; with dtau = s dxi it is smooth, and slip stops only as xi -> infinity along an invariant
// direction (g = 0, h < 0). After that: stick if mu_s >= |Wtt^-1 wtn|, else slip restarts along the one invariant
// direction with h > 0. Where Wtt is singular the stick force is that of the smallest norm and slip is along a line.
// Compression ends at the first v = 0, restitution as in core/models/planar/planar.h, which also has the regimes. Slip that
// turns can press the bodies together again in restitution: its net work counts then, and Poisson's impulse, once it is
// spent, is followed until v >= 0.
//
// Method: core/models/spatial/series-inl.h. Accuracy: `tolerance`, as far as double precision has it; error_estimate
// says what was reached (core/models/spatial/solver-inl.h derives it).
// Bad input: none gets here (core/scene/validate.h). That includes (u0, v0) outside the range of a singular W.

#ifndef RICOCHET_CORE_MODELS_SPATIAL_SPATIAL_H_
#define RICOCHET_CORE_MODELS_SPATIAL_SPATIAL_H_

#include <array>
#include <cstdint>

#include "core/models/impact_end.h"
#include "core/models/restitution_law.h"
#include "ricochet/outcome.h"

namespace ricochet::spatial {

// What impacts are integrated to where no request says how exactly: bounds and audits.
inline constexpr double kStudyTolerance = 1e-10;
// What the integration can be asked for.
inline constexpr double kLeastTolerance = 1e-12;
inline constexpr double kMostTolerance = 1e-4;

struct Problem {
  double w11 = 0.0, w12 = 0.0, w13 = 0.0, w22 = 0.0, w23 = 0.0, w33 = 0.0;  // 1/kg; n is the third direction
  std::array<double, 2> u0 = {};                                            // m/s
  double v0 = 0.0;                                                          // m/s; >= 0 is separating
  double mu = 0.0;
  double mu_static = 0.0;  // >= mu
  RestitutionLaw law = RestitutionLaw::kEnergetic;
  double coefficient = 0.0;
  double tolerance = 1e-10;  // Of each velocity after the impact over max(|u0|, |v0|); in [1e-12, 1e-4].
};

using Instant = ImpactInstant<std::array<double, 2>>;

// Limits count as broken where they are by more than the estimated error. The change of energy is p . (v- + v+)/2,
// never through an inverse of W.
struct Impact : ImpactEnd<std::array<double, 2>> {
  double error_estimate = 0.0;   // Not below the true error of the velocities over max(|u0|, |v0|).
  bool converged = true;         // False: wedged. A budget ran out, the state is that reached, the error infinite.
  bool closed_form = false;      // Slip never turns: no integration was needed.
  int64_t steps = 0;             // Series expanded.
  int64_t right_hand_sides = 0;  // Terms of them: what a Runge-Kutta method would call right-hand sides.
  std::array<Instant, 4> events;
  int event_count = 0;
};

Impact Solve(const Problem& problem);

}  // namespace ricochet::spatial

#endif  // RICOCHET_CORE_MODELS_SPATIAL_SPATIAL_H_
