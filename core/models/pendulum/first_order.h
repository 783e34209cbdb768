// First order: the nearly vertical pendulum to first order in x = mu |b|/a, in plain double arithmetic, no square root.
//
// Lubarda (2009), sec. 8. With the forms kappa_hat, kappa, eta and mu_hat of core/bounds/nearly_vertical.h, c the
// coefficient that the law gives and V = max(|u0|, |v0|) = max(a, |b|) |w-|:
//
//   kappa_hat, kappa, eta, mu_hat                  c itself, else a form                        [56], [59]
//   tau0 = -J w-/(a + mu |b|),  f0 = sgn(b) mu tau0                     exact                   [8], [48]
//   tau1 = (1 + kappa) tau0,  f1 = sgn(b) mu (1 - kappa) tau0           off as kappa is         [10], [48]
//   w+ = -kappa_hat w-,  u1 = b w+,  v1 = a w+                          off as kappa_hat is     [11]
//   Wc_n = a tau0 w-/2,  Wc_t = x Wc_n                                  exact                   [22], [34]
//   Wr_n = J w+^2/(2 (1 - x)),  Wr_t = -x Wr_n                          off as w+^2 is          [38], [39]
//   energy change = J (w+ - w-)(w+ + w-)/2                              off as w+^2 is          [16]
//
// so that the works add up to the change of energy, which is that of the velocities, to rounding. What is equal only in
// the exact impact differs here by O(x^2): mu_hat and f1/tau1, eta^2 and -Wr_n/Wc_n, Wr_n and a w+ (tau1 - tau0)/2.
//
// Errors, all O(x^2). With d(.) the bounds on the forms (nearly_vertical.h derives them):
//   |d u1|, |d v1| <= d(kappa_hat) V
//   Wnn |d tau1| = a |w-| d(kappa)/(1 + x),   Wtt |d f1| = x |b| |w-| d(kappa)/(1 + x)
//   law         d(kappa_hat)     d(kappa)/(1 + x)
//   energetic   c x^2/2          c x^2/(2 (1 - x^2))
//   Newton      0                2 c x^2/(1 - x^2)
//   Poisson     2 c x^2          0
// so that velocities are right to 2 c x^2 and impulses, times their mobility, to (8/3) c x^2 for x <= 1/2. Works of
// restitution and the change of energy: to J w-^2/2 (2 kappa_hat + d) d/(1 - x), d = d(kappa_hat).
// Rounding, eps = 2^-53, to first order: x 2 eps, 1 + x 2 eps, 1 - x 3 eps, 1 - 2x 4 eps of 1. Then kappa_hat is off by
// at most 5 eps c and the velocities, two products more, by 7 eps c V. kappa is off by 4 eps kappa, 1 + kappa by 5 eps
// of itself, tau0 by 4 eps, tau1 by 10 eps; f1 by 11 eps (1 + kappa) mu tau0. 8 and 12 eps cover higher orders, and the
// bounds of the forms, a few roundings of products, are enlarged by 2^-48 of themselves.
//
// mu = 0: the impact without friction, where the forms are exact, to the errors of rounding above.
// Bad input: problems that `Serves` refuses are not for this model, but for those without friction.

#ifndef RICOCHET_CORE_MODELS_PENDULUM_FIRST_ORDER_H_
#define RICOCHET_CORE_MODELS_PENDULUM_FIRST_ORDER_H_

#include <algorithm>
#include <cmath>

#include "core/models/pendulum/nearly_vertical_forms.h"
#include "core/models/pendulum/pendulum.h"
#include "core/models/relative_errors.h"
#include "core/models/restitution_law.h"

namespace ricochet::first_order {

using Problem = pendulum::Problem;
using Impact = pendulum::Impact;
using Instant = pendulum::Instant;
using Output = pendulum::Output;

inline constexpr double kLargestX = 0.5;

// What every output is made of.
struct Approximation {
  double x, one_minus_x;
  double newton, poisson, energetic, tangential;  // tangential: mu_hat/(mu sgn b)
  double tau0;
  double omega_plus;
  RelativeErrors errors;  // Proved bounds, rounding included.
};

// x as computed: 2 eps from the true one.
inline double FrictionRatio(const Problem& problem) { return problem.mu * std::fabs(problem.b) / problem.a; }

// Whether the model has an answer: the contact approaches, 0 < x <= kLargestX, friction does not lock the body, the
// coefficient is within the first-order bounds [57], so that it is admissible, and all numbers lie between 2^-100 and
// 2^100, so that no product leaves the range of doubles (coefficients may be 0). What rounding leaves open is refused.
inline bool Serves(const Problem& problem) {
  constexpr double kMargin = 0x1p-50;
  const auto moderate = [](double value) { return value >= 0x1p-100 && value <= 0x1p100; };
  if (!(moderate(problem.inertia) && moderate(problem.a) && moderate(std::fabs(problem.b)) &&
        moderate(-problem.omega_minus) && moderate(problem.mu))) {
    return false;
  }
  const double x = FrictionRatio(problem);
  if (!(x <= kLargestX)) return false;
  if (!(problem.mu_static * std::fabs(problem.b) < (1.0 - kMargin) * problem.a)) return false;
  const double c = problem.coefficient;
  if (c != 0.0 && !moderate(c)) return false;
  switch (problem.law) {
    case RestitutionLaw::kEnergetic:
      return c <= 1.0;
    case RestitutionLaw::kNewton:
      return c <= 1.0 - x - kMargin;
    case RestitutionLaw::kPoisson:
      return c <= 1.0 + x - kMargin;
  }
  return false;
}

inline Approximation Approximate(const Problem& problem) {
  constexpr double kEps = 0x1p-53;
  constexpr double kEnlarged = 1.0 + 0x1p-48;
  const double size = std::fabs(problem.b);
  const double x = FrictionRatio(problem);
  const double one_plus_x = 1.0 + x;
  const auto forms = pendulum::CoefficientForms(problem.law, problem.coefficient, x, 1.0 - x, one_plus_x);
  const double kappa = forms.poisson.value;
  // Of a |w-| and x |b| |w-|, in units of V.
  const double share = std::max(problem.a, x * size) / (std::max(problem.a, size) * one_plus_x);
  return {.x = x,
          .one_minus_x = 1.0 - x,
          .newton = forms.newton.value,
          .poisson = kappa,
          .energetic = forms.energetic.value,
          .tangential = forms.tangential.value,
          .tau0 = problem.inertia * -problem.omega_minus / (problem.a + problem.mu * size),
          .omega_plus = -forms.newton.value * problem.omega_minus,
          .errors = {.velocity = kEnlarged * forms.newton.error + 8.0 * kEps * problem.coefficient,
                     .impulse = share * (kEnlarged * forms.poisson.error + 12.0 * kEps * (1.0 + kappa))}};
}

// One output, as cheap as it can be.
inline double Value(const Problem& problem, const Approximation& of, Output output) {
  const auto& [x, one_minus_x, newton, poisson, energetic, tangential, tau0, omega_plus, errors] = of;
  const double mu = std::copysign(problem.mu, problem.b);
  const double omega = problem.omega_minus;
  const double normal_compression = 0.5 * problem.a * tau0 * omega;
  const double normal_restitution = 0.5 * problem.inertia * omega_plus * omega_plus / one_minus_x;
  switch (output) {
    case Output::kNewton:
      return newton;
    case Output::kPoisson:
      return poisson;
    case Output::kEnergetic:
      return energetic;
    case Output::kTangentialCoefficient:
      return mu * tangential + 0.0;
    case Output::kOmegaPlus:
      return omega_plus + 0.0;
    case Output::kTangentialVelocityAfter:
      return problem.b * omega_plus + 0.0;
    case Output::kNormalVelocityAfter:
      return problem.a * omega_plus + 0.0;
    case Output::kNormalImpulseCompression:
      return tau0;
    case Output::kNormalImpulse:
      return (1.0 + poisson) * tau0;
    case Output::kTangentialImpulse:
      return mu * ((1.0 - poisson) * tau0) + 0.0;
    case Output::kTangentialImpulseCompression:
      return mu * tau0 + 0.0;
    case Output::kWorkNormalCompression:
      return normal_compression;
    case Output::kWorkNormalRestitution:
      return normal_restitution;
    case Output::kWorkTangentialCompression:
      return x * normal_compression + 0.0;
    case Output::kWorkTangentialRestitution:
      return 0.0 - x * normal_restitution;
    case Output::kWorkNormal:
      return normal_compression + normal_restitution;
    case Output::kWorkTangential:
      return x * (normal_compression - normal_restitution) + 0.0;
    case Output::kEnergyChange:
      return 0.5 * problem.inertia * ((omega_plus - omega) * (omega_plus + omega));
    case Output::kEnergeticExcess:
      return energetic - 1.0;
  }
  return 0.0;
}

// Bounds on the errors of contact velocity and impulses; cheaper than an impact.
inline RelativeErrors ErrorsOf(const Problem& problem) { return Approximate(problem).errors; }

// Everything about one impact: no limit is broken.
Impact Solve(const Problem& problem);

// kRebound, without friction kFrictionless.
inline Regime RegimeOf(const Problem& problem) { return problem.mu > 0.0 ? Regime::kRebound : Regime::kFrictionless; }

// The contact at normal impulse tau in [0, tau1]: [7], [12], [48] through tau0, tau1 and w+ of the model.
// Accuracy: 4 ulp of |w-| or of mu tau0.
Instant At(const Problem& problem, double tau);

}  // namespace ricochet::first_order

#endif  // RICOCHET_CORE_MODELS_PENDULUM_FIRST_ORDER_H_
