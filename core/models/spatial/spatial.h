// Spatial: one frictional impact at one point in space, with slip that turns, stops, sticks and starts again.
//
// W is a symmetric positive semidefinite 3 x 3 matrix (t1, t2, n). Solve follows Keller's equations over the normal
// impulse tau: slip changes its speed and direction until it stops. Then the contact sticks if mu_s >= |Wtt^-1 wtn|,
// and otherwise slips again in the one direction in which slip grows. Compression ends at the first v = 0. Regimes are
// those of core/models/planar/planar.h.
// Units: SI. Accuracy: `tolerance`, as far as double precision has it; error_estimate says what was reached.
// Where (u0, v0) lies beside the range of a singular W, a contact that sticks may keep a v < 0: it jams, the path has
// no end, and the result is the state reached (wedged, refused). Bad input: none gets here (core/scene/validate.h).
// Source: Keller (1986). docs/theory/spatial.md has the equations, the method and the error estimate.

#ifndef RICOCHET_CORE_MODELS_SPATIAL_SPATIAL_H_
#define RICOCHET_CORE_MODELS_SPATIAL_SPATIAL_H_

#include <array>
#include <cstdint>

#include "core/contact/delassus.h"
#include "core/models/impact_end.h"
#include "core/models/impact_errors.h"
#include "core/models/restitution_law.h"
#include "ricochet/outcome.h"

namespace ricochet::spatial {

// The tolerance of impacts in bounds and audits, where no request states one.
inline constexpr double kStudyTolerance = 1e-10;
// The range of tolerances that Solve accepts.
inline constexpr double kLeastTolerance = 1e-12;
inline constexpr double kMostTolerance = 1e-2;

struct Problem {
  double w11 = 0.0, w12 = 0.0, w13 = 0.0, w22 = 0.0, w23 = 0.0, w33 = 0.0;  // 1/kg; n is the third direction
  std::array<double, 2> u0 = {};                                            // m/s
  double v0 = 0.0;                                                          // m/s; >= 0 is separating
  double mu = 0.0;
  double mu_static = 0.0;  // >= mu
  RestitutionLaw law = RestitutionLaw::kEnergetic;
  double coefficient = 0.0;
  double tolerance = 1e-10;  // error allowed in each velocity after the impact, over max(|u0|, |v0|)

  SpatialDelassus Delassus() const { return {{w11, w12, w13, w22, w23, w33}}; }
};

using Instant = ImpactInstant<std::array<double, 2>>;

// A limit counts as broken where it is exceeded by more than the estimated error. The change of energy is
// p . (v- + v+)/2, so that no inverse of W is needed.
struct Impact : ImpactEnd<std::array<double, 2>> {
  double error_estimate = 0.0;   // not below the true error of the velocities, over max(|u0|, |v0|)
  bool closed_form = false;      // Slip never turns, so that no integration was needed.
  int64_t steps = 0;             // series expanded, in all attempts
  int64_t right_hand_sides = 0;  // terms of all series: a Runge-Kutta method would call them right-hand sides
  ImpactErrors errors;           // not below the true errors; infinite if the path has not ended
  std::array<Instant, 5> events;
  int event_count = 0;
};

Impact Solve(const Problem& problem);

}  // namespace ricochet::spatial

#endif  // RICOCHET_CORE_MODELS_SPATIAL_SPATIAL_H_
