// First order: the nearly vertical pendulum to first order in x = mu |b|/a, in plain double arithmetic, no square root.
//
// Lubarda (2009), sec. 9. The coefficients are the forms of core/bounds/pendulum_bounds.h. tau0, f0 and the works of
// compression are exact; tau1, f1, omega+ and all that follows from them have the errors of kappa and kappa_hat, which
// are of order x^2. Works add up to the change of energy up to rounding. For x <= 1/2 and with c, the coefficient that
// the law states, velocities are right to 2 c x^2 of max(|u0|, |v0|), and impulses times their mobility to (8/3) c x^2.
// docs/theory/pendulum_numerics.md lists the formulas, their errors and their rounding. For mu = 0 or b = 0 this is the
// impact without friction, whose forms are exact up to rounding. The model has no answer for a problem with mu > 0 that
// `Serves` refuses.

#ifndef RICOCHET_CORE_MODELS_PENDULUM_FIRST_ORDER_H_
#define RICOCHET_CORE_MODELS_PENDULUM_FIRST_ORDER_H_

#include <algorithm>
#include <cmath>

#include "core/models/impact_errors.h"
#include "core/models/pendulum/nearly_vertical_forms.h"
#include "core/models/pendulum/parts.h"
#include "core/models/pendulum/pendulum.h"
#include "core/models/restitution_law.h"
#include "core/numerics/moderate.h"

namespace ricochet::first_order {

using Problem = pendulum::Problem;
using Impact = pendulum::Impact;
using Instant = pendulum::Instant;
using Output = pendulum::Output;

inline constexpr double kLargestX = 0.5;

// The quantities from which every output is computed.
struct Approximation {
  double x;
  double newton, poisson, energetic, tangential;  // tangential: mu_hat/(mu sgn b)
  double tau0;
  double omega_plus;
  RelativeErrors errors;  // Proved bounds, rounding included.
};

// The computed x, which differs from the exact one by at most 2 eps of it.
inline double FrictionRatio(const Problem& problem) { return problem.mu * std::fabs(problem.b) / problem.a; }

// True if the model has an answer: the contact approaches, 0 < x <= kLargestX, friction does not lock the body, the
// coefficient is within the first-order bounds [57], so that it is admissible, and all numbers lie between 2^-100 and
// 2^100, so that no product leaves the range of doubles (coefficients may be 0). A case that rounding cannot decide is
// refused.
inline bool Serves(const Problem& problem) {
  constexpr double kMargin = 0x1p-50;
  const double c = problem.coefficient;
  if (problem.omega_minus >= 0.0 || problem.b == 0.0 || problem.mu == 0.0) return false;
  if (!AreModerate({problem.inertia, problem.a, problem.b, problem.omega_minus, problem.mu, c}, 0x1p100)) return false;
  const double x = FrictionRatio(problem);
  if (!(x <= kLargestX)) return false;
  if (!(problem.mu_static * std::fabs(problem.b) < (1.0 - kMargin) * problem.a)) return false;
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
  // The larger of a |omega-| and x |b| |omega-|, over (1 + x) V.
  const double share = std::max(problem.a, x * size) / (std::max(problem.a, size) * one_plus_x);
  return {.x = x,
          .newton = forms.newton.value,
          .poisson = kappa,
          .energetic = forms.energetic.value,
          .tangential = forms.tangential.value,
          .tau0 = problem.inertia * -problem.omega_minus / (problem.a + problem.mu * size),
          .omega_plus = -forms.newton.value * problem.omega_minus,
          .errors = {.velocity = kEnlarged * forms.newton.error + 8.0 * kEps * problem.coefficient,
                     .impulse = share * (kEnlarged * forms.poisson.error + 12.0 * kEps * (1.0 + kappa))}};
}

// Computes one output.
inline double Value(const Problem& problem, const Approximation& of, Output output) {
  const auto& [x, newton, poisson, energetic, tangential, tau0, omega_plus, errors] = of;
  const double mu = SignedFriction(problem);
  const double omega = problem.omega_minus;
  const double normal_compression = 0.5 * problem.a * tau0 * omega;
  const double normal_restitution = 0.5 * problem.inertia * omega_plus * omega_plus / (1.0 - x);
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

// Computes all outputs of one impact. It breaks no limit.
Impact Solve(const Problem& problem);

// The errors of all numbers of that impact, each on its own scale: those of the forms, and rounding.
ImpactErrors NumberErrorsOf(const Problem& problem, const Impact& impact);

// The regime is kRebound, or kFrictionless if mu = 0 or b = 0.
inline Regime RegimeOf(const Problem& problem) { return pendulum::RegimeOf(problem, /*locked=*/false); }

// The state at normal impulse tau in [0, tau1], by [7], [12] and [48] with tau0, tau1 and omega+ of the model.
// Accuracy: 4 ulp of |omega-| or of mu tau0.
Instant At(const Problem& problem, double tau);

}  // namespace ricochet::first_order

#endif  // RICOCHET_CORE_MODELS_PENDULUM_FIRST_ORDER_H_
