// LargestChange: a bound on the change of an impact at its end, from a bound on the change of its path.
//
// Velocities are scaled by |v0|, mobilities by Wnn, normal impulses by |v0|/Wnn, so that v(0) = -1, v' = 1 + wtn f' and
// w = |Wtn|/Wnn, W = Wtt/Wnn. A and B are two impacts from the same start under the same law of restitution, tau the
// normal impulse, ' = d/dtau:
//
//   A  lo <= v_A' <= hi with lo > 0, |u_A'| <= U, |f_A'| <= F
//   B  |f_B - f_A| <= e_f(tau) = j + m (tau - from)+, |v_B - v_A| <= e_v = w e_f + q, |u_B - u_A| <= e_u = W e_f + p
//      and, if it is known, bl <= v_B' <= bh with bl > 0
//
// docs/theory/plan.md, section 5, proves the bound. The answer is infinite if a slope is below kLeastSlope or nothing
// is known. The inputs must be right to 2^-30, and `from` must not exceed its true value; the answer then covers
// rounding.

#ifndef RICOCHET_CORE_PLAN_PERTURBED_PATH_H_
#define RICOCHET_CORE_PLAN_PERTURBED_PATH_H_

#include <limits>

#include "core/models/pendulum/pendulum.h"
#include "core/models/restitution_law.h"

namespace ricochet {

inline constexpr double kUnbounded = std::numeric_limits<double>::infinity();
inline constexpr double kLeastSlope = 0x1p-20;  // The least slope v' that a bound allows, over Wnn.

struct Restoring {
  RestitutionLaw law = RestitutionLaw::kEnergetic;
  double coefficient = 0.0;
};

struct Mobility {
  double tangential = 0.0;  // W
  double coupling = 0.0;    // w
};

struct ReferencePath {
  double slope_low = 1.0;   // lo
  double slope_high = 1.0;  // hi
  double u_slope = 0.0;     // U
  double f_slope = 0.0;     // F
};

struct Perturbation {
  double f_jump = 0.0;   // j
  double f_slope = 0.0;  // m
  double from = 0.0;
  double u = 0.0;           // p
  double v = 0.0;           // q
  double slope_low = 0.0;   // bl; 0 if it is not known.
  double slope_high = 0.0;  // bh
};

// Bounds the largest of |d u1|, |d v1|, |d tau1| and Wtt |d f1|, scaled; infinite if no bound is known.
double LargestChange(const Mobility& mobility, const Restoring& restoring, const ReferencePath& reference,
                     const Perturbation& perturbation);

// Enlarges a bound to cover the rounding of itself and of the numbers that it was computed from. NaN becomes infinite.
double WithRoundingMargin(double bound);

}  // namespace ricochet

#endif  // RICOCHET_CORE_PLAN_PERTURBED_PATH_H_
