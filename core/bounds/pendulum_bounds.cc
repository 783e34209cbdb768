#include "core/bounds/pendulum_bounds.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/models/pendulum/nearly_vertical_forms.h"
#include "core/models/pendulum/wide.h"
#include "core/models/restitution_law.h"

namespace ricochet::pendulum {
namespace {

// Returns the largest double <= `bound` that Solve accepts as admissible.
double LargestAdmissible(Problem problem, RestitutionLaw law, double bound) {
  problem.law = law;
  // The rate of the pendulum does not matter to whether a coefficient is admissible.
  problem.omega_minus = -1.0;
  problem.coefficient = bound;
  while (Solve(problem).sharp_limit_broken) {
    problem.coefficient = std::nextafter(problem.coefficient, 0.0);
  }
  return problem.coefficient;
}

// The range [lower, upper] of mu_hat is stated for b > 0; it is mirrored for b < 0.
Range Signed(double lower, double upper, double b) {
  if (b < 0.0) return {0.0 - upper, 0.0 - lower};
  return {lower, upper};
}

CoefficientBounds LockedBounds(const Problem& problem, double tau0) {
  const double mu = problem.b == 0.0 ? 0.0 : problem.mu;
  CoefficientBounds bounds;
  bounds.tangential = Signed(mu, mu, problem.b);
  bounds.normal_total_n_s = {tau0, tau0};
  return bounds;
}

CoefficientBounds SharpBounds(const Problem& problem, const WideSolution& x, const Wide& tau0) {
  const Wide one = Wide::Exactly(1.0);
  const Wide root = Sqrt(x.d / x.s);
  // (1 - x)(1 + x) = d s/a^2
  const Wide cosine = Sqrt(x.d * x.s) / x.a;
  const double mu = std::fabs(Rounded(x.mu));
  const double tangential = Rounded(Wide::Exactly(mu) * (x.q / x.a) / (one + cosine));
  CoefficientBounds bounds;
  bounds.newton.upper = LargestAdmissible(problem, RestitutionLaw::kNewton, Rounded(root));
  bounds.poisson.upper = LargestAdmissible(problem, RestitutionLaw::kPoisson, Rounded(one / root));
  bounds.energetic.upper = 1.0;
  bounds.tangential = Signed(0.0 - tangential, mu, problem.b);
  bounds.normal_total_n_s = {Rounded(tau0), Rounded((one + one / root) * tau0)};
  return bounds;
}

CoefficientBounds EnergyOnlyBounds(const Problem& problem, const WideSolution& x, const Wide& tau0) {
  const Wide two = Wide::Exactly(2.0);
  const double mu = std::fabs(Rounded(x.mu));
  CoefficientBounds bounds;
  bounds.newton.upper = 1.0;
  bounds.poisson.upper = Rounded(x.s / x.d);
  bounds.energetic.upper = Rounded(Sqrt(x.s / x.d));
  bounds.tangential = Signed(0.0 - Rounded(Wide::Exactly(mu) * x.q / x.a), mu, problem.b);
  bounds.normal_total_n_s = {Rounded(tau0), Rounded(two * x.a / x.d * tau0)};
  return bounds;
}

// Because W has rank one, any friction stops slip exactly where compression ends, and slip then reverses unless the
// contact locks.
CriticalFriction FindCriticalFriction(const Problem& problem) {
  const double lock = problem.a / std::fabs(problem.b);
  CriticalFriction critical;
  if (!std::isfinite(lock)) return critical;
  critical.stick = lock;
  critical.stop = critical.reversal = 0.0;
  return critical;
}

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

Bounds SolveBounds(const Problem& problem) {
  const WideSolution x = SolveGeometry(problem);
  const bool separating = problem.omega_minus >= 0.0;
  const Wide tau0 = separating ? Wide() : x.inertia * -x.omega / x.s;
  Bounds bounds;
  bounds.regime = separating ? Regime::kSeparating : RegimeOf(problem, x.locked);
  bounds.friction_ratio = Rounded(x.q / x.a);
  bounds.slope_ratio = Rounded(x.d / x.s);
  if (!separating) bounds.critical = FindCriticalFriction(problem);
  if (x.locked) {
    bounds.sharp = LockedBounds(problem, Rounded(tau0));
    bounds.energy_only = bounds.sharp;
    return bounds;
  }
  bounds.sharp = SharpBounds(problem, x, tau0);
  bounds.energy_only = EnergyOnlyBounds(problem, x, tau0);
  return bounds;
}

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
