// Nearly vertical impact: first order in x = mu |b|/a, Lubarda (2009) [56]-[60], each form with a bound on its error.
//
//   kappa = (1 + x) eta = (1 + 2x) kappa_hat,  kappa_hat = (1 - x) eta = (1 - 2x) kappa               [56]
//   kappa_hat <= 1 - x,  kappa <= 1 + x,  tau1 <= (2 + x) tau0                                        [57], [58]
//   mu_hat = mu ((1 - eta)/(1 + eta) - 2 x eta/(1 + eta)^2)                                           [59]
//   mu_hat >= -mu x/2                                                                                 [60]
//
// Errors, for 0 <= x < 1, with c = sqrt(1 - x^2) and exact kappa_hat = eta (1-x)/c, kappa = eta (1+x)/c:
//   (1-x)/c - (1-x) = x^2 (1-x)/(c (1+c)) <= x^2/2            since 2 (1-x) <= c + c^2
//   (1+x)/c - (1+x) = x^2 (1+x)/(c (1+c)) <= x^2/(2 (1-x))    since (1+x)(1-x) = c^2 and c/(1+c) <= 1/2
//   mu x/(1+c) - mu x/2 = mu x^3/(2 (1+c)^2)  <= mu x^3/2
//   mu_hat/mu = -tanh(theta), theta = (ln eta + atanh x)/2; its second derivative in x,
//   sech^2(theta) (tanh(theta)/2 - x)/(1-x^2)^2, is at most (1/5 + x)/(1-x^2)^2, because sech^2 tanh <= 2/(3 sqrt 3):
//   the error of [59] is at most mu x^2 (1/10 + x/2)/(1-x^2)^2.
// At a given Newton's coefficient e: kappa = e (1+x)/(1-x), so kappa's form e (1 + 2x) is off by 2 e x^2/(1-x) and
// eta's, e (1+x), as kappa's above; mu_hat/mu = -tanh(ln e/2 + atanh x), whose second derivative is at most
// (4/5 + 2x)/(1-x^2)^2: its form (1-e)/(1+e) - 4 x e/(1+e)^2 is off by at most x^2 (2/5 + x)/(1-x^2)^2.
// At a given Poisson's coefficient k: kappa_hat's form k (1 - 2x) is off by 2 k x^2/(1+x) <= 2 k x^2, eta's, k (1-x),
// as kappa_hat's above; mu_hat is exact.

#ifndef RICOCHET_CORE_BOUNDS_NEARLY_VERTICAL_H_
#define RICOCHET_CORE_BOUNDS_NEARLY_VERTICAL_H_

#include "core/models/pendulum/pendulum.h"
#include "ricochet/bounds.h"

namespace ricochet::pendulum {

// First-order bounds and their errors; with `with_coefficients` also the coefficients at the problem's coefficient.
// The problem must have x < 1. Values carry a few ulp of rounding; the errors are rounded up by 8 ulp of the value
// they belong to (by 2 units of 2^-1074 where that is subnormal), so that they enclose it.
NearlyVertical SolveNearlyVertical(const Problem& problem, bool with_coefficients);

}  // namespace ricochet::pendulum

#endif  // RICOCHET_CORE_BOUNDS_NEARLY_VERTICAL_H_
