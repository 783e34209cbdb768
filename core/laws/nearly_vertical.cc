#include "core/laws/nearly_vertical.h"

#include <cmath>
#include <limits>

#include "core/models/pendulum_wide.h"

namespace ricochet::pendulum {
namespace {

// An error bound that also covers the rounding of the value it belongs to, and its own.
double Enclosing(const Wide& error, const Wide& value) {
  constexpr double kUlp = std::numeric_limits<double>::epsilon();
  const Wide size = IsNegative(value) ? -value : value;
  const Wide padded = error * Wide::Exactly(1.0 + 4.0 * kUlp) + size * Wide::Exactly(8.0 * kUlp);
  const double bound = Rounded(padded);
  // Below the normal doubles an ulp is no fraction of the value.
  const bool subnormal = IsPositive(padded) && bound < std::numeric_limits<double>::min();
  return subnormal ? bound + 2.0 * std::numeric_limits<double>::denorm_min() : bound;
}

struct FirstOrder {
  Wide value;
  Wide error;
};

// The three coefficients and mu_hat/mu, each to first order in x.
struct FirstOrderCoefficients {
  FirstOrder newton, poisson, energetic, tangential;
};

// (1 - c)/(1 + c) - g x 2c/(1 + c)^2, the expansion of mu_hat/mu where kappa = c ((1 + x)/(1 - x))^(g/2).
Wide TangentialForm(const Wide& c, const Wide& x, double g) {
  const Wide one = Wide::Exactly(1.0);
  const Wide sum = one + c;
  return (one - c) / sum - Wide::Exactly(2.0 * g) * x * c / (sum * sum);
}

FirstOrderCoefficients Coefficients(const Problem& problem, const Wide& x, const Wide& one_minus_x,
                                    const Wide& one_plus_x) {
  const Wide c = Wide::Exactly(problem.coefficient);
  const Wide square = x * x;
  const Wide half = Wide::Exactly(0.5);
  const Wide two = Wide::Exactly(2.0);
  const Wide product = one_minus_x * one_plus_x;
  const Wide denominator = product * product;
  const Wide lowered = c * square * half;                // of (1 - x) c
  const Wide raised = c * square / (two * one_minus_x);  // of (1 + x) c
  switch (problem.law) {
    case Law::kEnergetic:
      return {.newton = {one_minus_x * c, lowered},
              .poisson = {one_plus_x * c, raised},
              .energetic = {c, Wide()},
              .tangential = {TangentialForm(c, x, 1.0),
                             square * (Wide::Exactly(1.0) / Wide::Exactly(10.0) + half * x) / denominator}};
    case Law::kNewton:
      return {.newton = {c, Wide()},
              .poisson = {(one_plus_x + x) * c, two * square * c / one_minus_x},
              .energetic = {one_plus_x * c, raised},
              .tangential = {TangentialForm(c, x, 2.0), square * (two / Wide::Exactly(5.0) + x) / denominator}};
    case Law::kPoisson:
      return {.newton = {(one_minus_x - x) * c, two * square * c},
              .poisson = {c, Wide()},
              .energetic = {one_minus_x * c, lowered},
              .tangential = {TangentialForm(c, x, 0.0), Wide()}};
  }
  return {};
}

}  // namespace

NearlyVertical SolveNearlyVertical(const Problem& problem, bool with_coefficients) {
  const WideSolution geometry = SolveGeometry(problem);
  const Wide x = geometry.q / geometry.a;
  const Wide one_minus_x = geometry.d / geometry.a;
  const Wide one_plus_x = geometry.s / geometry.a;
  const Wide tau0 = problem.omega_minus >= 0.0 ? Wide() : geometry.inertia * -geometry.omega / geometry.s;
  const Wide mu = geometry.mu;  // Carries the sign of b.
  const double mu_size = std::fabs(Rounded(mu));
  const Wide half = Wide::Exactly(0.5);
  const Wide square = x * x;
  const Wide poisson_error = square * half / one_minus_x;

  NearlyVertical result;
  result.bounds.newton.upper = Rounded(one_minus_x);
  result.bounds.poisson.upper = Rounded(one_plus_x);
  result.bounds.energetic.upper = 1.0;
  const Wide least = Wide::Exactly(mu_size) * x * half;  // -mu_hat
  const double tangential = Rounded(least);
  result.bounds.tangential = problem.b < 0.0 ? Range{0.0 - mu_size, tangential} : Range{0.0 - tangential, mu_size};
  const Wide normal_total = (one_plus_x + Wide::Exactly(1.0)) * tau0;
  result.bounds.normal_total_n_s = {Rounded(tau0), Rounded(normal_total)};
  result.newton_error = Enclosing(square * half, one_minus_x);
  result.poisson_error = Enclosing(poisson_error, one_plus_x);
  result.tangential_error = Enclosing(Wide::Exactly(mu_size) * square * x * half, least);
  result.normal_total_error_n_s = Enclosing(poisson_error * tau0, normal_total);
  if (!with_coefficients) return result;

  const auto form = Coefficients(problem, x, one_minus_x, one_plus_x);
  const Wide mu_hat = mu * form.tangential.value;
  result.coefficients = {.newton = Rounded(form.newton.value) + 0.0,
                         .poisson = Rounded(form.poisson.value),
                         .energetic = Rounded(form.energetic.value),
                         .tangential = Rounded(mu_hat) + 0.0};
  result.coefficient_errors = {.newton = Enclosing(form.newton.error, form.newton.value),
                               .poisson = Enclosing(form.poisson.error, form.poisson.value),
                               .energetic = Enclosing(form.energetic.error, form.energetic.value),
                               .tangential = Enclosing(Wide::Exactly(mu_size) * form.tangential.error, mu_hat)};
  return result;
}

}  // namespace ricochet::pendulum
