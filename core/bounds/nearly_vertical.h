// SolveNearlyVertical: the bounds of a nearly vertical impact to first order in x = mu |b|/a, Lubarda (2009) [56]-[60],
// each with a bound on its error.
//
//   kappa = (1 + x) eta = (1 + 2x) kappa_hat,  kappa_hat = (1 - x) eta = (1 - 2x) kappa               [56]
//   kappa_hat <= 1 - x,  kappa <= 1 + x,  tau1 <= (2 + x) tau0                                        [57], [58]
//   mu_hat = mu ((1 - eta)/(1 + eta) - 2 x eta/(1 + eta)^2) >= -mu x/2                                [59], [60]
//
// The errors are of order x^2; docs/theory/bounds.md derives them. Units are those of core/models/pendulum/pendulum.h.
// Bad input: none gets here (core/scene/validate.h).

#ifndef RICOCHET_CORE_BOUNDS_NEARLY_VERTICAL_H_
#define RICOCHET_CORE_BOUNDS_NEARLY_VERTICAL_H_

#include "core/models/pendulum/pendulum.h"
#include "ricochet/bounds.h"

namespace ricochet::pendulum {

// Gives first-order bounds and their errors, and if `with_coefficients` also the coefficients at the problem's
// coefficient. The problem must have x < 1. Values carry a few ulp of rounding. The errors are rounded up by 8 ulp of
// the value they belong to, or by 2 units of 2^-1074 if that value is subnormal, so they enclose that rounding too.
NearlyVertical SolveNearlyVertical(const Problem& problem, bool with_coefficients);

}  // namespace ricochet::pendulum

#endif  // RICOCHET_CORE_BOUNDS_NEARLY_VERTICAL_H_
