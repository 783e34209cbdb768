// SolveBounds: the bounds of the pendulum's coefficients, [27]-[31], [54], [55]; ricochet/bounds.h has the formulas.
// SolveNearlyVertical: their forms for a pendulum whose tip hangs nearly straight below its pin.
//
// Accuracy: 1 ulp, but an upper bound of `sharp` that rounding would push past what Solve accepts as admissible is the
// next double below. -(a/|b|)(1 - sqrt(1 - x^2)) is computed as -mu x/(1 + sqrt(1 - x^2)), in which nothing cancels
// near x = 0; near x = 1 the code uses 1 - x^2 = (1 - x)(1 + x). Bad input: none gets here (core/scene/validate.h).

#ifndef RICOCHET_CORE_BOUNDS_PENDULUM_BOUNDS_H_
#define RICOCHET_CORE_BOUNDS_PENDULUM_BOUNDS_H_

#include "core/models/pendulum/pendulum.h"
#include "ricochet/bounds.h"

namespace ricochet::pendulum {

// `problem.coefficient` is not used.
Bounds SolveBounds(const Problem& problem);

// Gives the bounds of a nearly vertical impact to first order in x = mu |b|/a, Lubarda (2009) [56]-[60],
//
//   kappa = (1 + x) eta = (1 + 2x) kappa_hat,  kappa_hat = (1 - x) eta = (1 - 2x) kappa               [56]
//   kappa_hat <= 1 - x,  kappa <= 1 + x,  tau1 <= (2 + x) tau0                                        [57], [58]
//   mu_hat = mu ((1 - eta)/(1 + eta) - 2 x eta/(1 + eta)^2) >= -mu x/2                                [59], [60]
//
// each with a bound on its error of order x^2 (docs/theory/bounds.md), and if `with_coefficients` also the coefficients
// at the problem's coefficient. The problem must have x < 1. Values carry a few ulp of rounding. The errors are rounded
// up by 8 ulp of the value they belong to, or by 2 units of 2^-1074 if that value is subnormal, so they enclose that
// rounding too.
NearlyVertical SolveNearlyVertical(const Problem& problem, bool with_coefficients);

}  // namespace ricochet::pendulum

#endif  // RICOCHET_CORE_BOUNDS_PENDULUM_BOUNDS_H_
