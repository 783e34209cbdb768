#include "core/bounds/nearly_vertical.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/models/pendulum/nearly_vertical_forms.h"
#include "core/models/pendulum/wide.h"

namespace ricochet::pendulum {
namespace {

// Widens an error bound so that it also covers the rounding of the value it belongs to, and its own.
double Enclosing(const Wide& error, const Wide& value) {
  constexpr double kUlp = std::numeric_limits<double>::epsilon();
  const Wide size = IsNegative(value) ? -value : value;
  const Wide padded = error * Wide::Exactly(1.0 + 4.0 * kUlp) + size * Wide::Exactly(8.0 * kUlp);
  const double bound = Rounded(padded);
  // An ulp of a subnormal double is no fixed fraction of the value.
  const bool subnormal = IsPositive(padded) && bound < std::numeric_limits<double>::min();
  return subnormal ? bound + 2.0 * std::numeric_limits<double>::denorm_min() : bound;
}

}  // namespace

NearlyVertical SolveNearlyVertical(const Problem& problem, bool with_coefficients) {
  const WideSolution geometry = SolveGeometry(problem);
  const Wide x = geometry.q / geometry.a;
  const Wide one_minus_x = geometry.d / geometry.a;
  const Wide one_plus_x = geometry.s / geometry.a;
  const Wide tau0 = problem.omega_minus >= 0.0 ? Wide() : geometry.inertia * -geometry.omega / geometry.s;
  const Wide mu = geometry.mu;  // It carries the sign of b.
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

  const auto form = CoefficientForms(problem.law, Wide::Exactly(problem.coefficient), x, one_minus_x, one_plus_x);
  const Wide mu_hat = mu * form.tangential.value;
  result.coefficients = {.newton = Rounded(form.newton.value) + 0.0,
                         .poisson = Rounded(form.poisson.value),
                         .energetic = Rounded(form.energetic.value),
                         .tangential = Rounded(mu_hat) + 0.0};
  result.coefficient_errors = {.newton = Enclosing(form.newton.error, form.newton.value),
                               .poisson = Enclosing(form.poisson.error, form.poisson.value),
                               .energetic = Enclosing(form.energetic.error, form.energetic.value),
                               .tangential = Enclosing(Wide::Exactly(mu_size) * form.tangential.error, mu_hat)};
  // The exact |mu_hat| is at most mu.
  const double apart = 1.0000000000000004 * (std::fabs(result.coefficients->tangential) + mu_size);
  result.coefficient_errors.tangential = std::min(result.coefficient_errors.tangential, apart);
  return result;
}

}  // namespace ricochet::pendulum
