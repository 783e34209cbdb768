// Nearly vertical forms: the first-order forms of the coefficients and their errors, over a number type N, which is
// double or a wider type. core/bounds/pendulum_bounds.h derives them.

#ifndef RICOCHET_CORE_MODELS_PENDULUM_NEARLY_VERTICAL_FORMS_H_
#define RICOCHET_CORE_MODELS_PENDULUM_NEARLY_VERTICAL_FORMS_H_

#include "core/models/pendulum/pendulum.h"
#include "core/models/restitution_law.h"

namespace ricochet::pendulum {

// A form and a bound on its error, which does not include rounding.
template <typename N>
struct FirstOrder {
  N value{};
  N error{};
};

// The three coefficients and |mu_hat|/mu, each to first order in x.
template <typename N>
struct FirstOrderCoefficients {
  FirstOrder<N> newton, poisson, energetic, tangential;
};

// Converts a double to N exactly.
template <typename N>
N Exactly(double value) {
  return N::Exactly(value);
}
template <>
inline double Exactly(double value) {
  return value;
}

// (1 - c)/(1 + c) - g x 2c/(1 + c)^2, the expansion of mu_hat/mu where kappa = c ((1 + x)/(1 - x))^(g/2).
template <typename N>
N TangentialForm(const N& c, const N& x, double g) {
  const N one = Exactly<N>(1.0);
  const N sum = one + c;
  return (one - c) / sum - Exactly<N>(2.0 * g) * x * c / (sum * sum);
}

// `c` is the coefficient that `law` defines; 0 <= x < 1.
template <typename N>
FirstOrderCoefficients<N> CoefficientForms(RestitutionLaw law, const N& c, const N& x, const N& one_minus_x,
                                           const N& one_plus_x) {
  const N square = x * x;
  const N half = Exactly<N>(0.5);
  const N two = Exactly<N>(2.0);
  const N product = one_minus_x * one_plus_x;
  const N denominator = product * product;
  const N lowered = c * square * half;                // error of (1 - x) c
  const N raised = c * square / (two * one_minus_x);  // error of (1 + x) c
  const N exact = Exactly<N>(0.0);
  switch (law) {
    case RestitutionLaw::kEnergetic:
      return {.newton = {one_minus_x * c, lowered},
              .poisson = {one_plus_x * c, raised},
              .energetic = {c, exact},
              .tangential = {TangentialForm(c, x, 1.0),
                             square * (Exactly<N>(1.0) / Exactly<N>(10.0) + half * x) / denominator}};
    case RestitutionLaw::kNewton:
      return {.newton = {c, exact},
              .poisson = {(one_plus_x + x) * c, two * square * c / one_minus_x},
              .energetic = {one_plus_x * c, raised},
              .tangential = {TangentialForm(c, x, 2.0), square * (two / Exactly<N>(5.0) + x) / denominator}};
    case RestitutionLaw::kPoisson:
      return {.newton = {(one_minus_x - x) * c, two * square * c},
              .poisson = {c, exact},
              .energetic = {one_minus_x * c, lowered},
              .tangential = {TangentialForm(c, x, 0.0), exact}};
  }
  return {};
}

}  // namespace ricochet::pendulum

#endif  // RICOCHET_CORE_MODELS_PENDULUM_NEARLY_VERTICAL_FORMS_H_
