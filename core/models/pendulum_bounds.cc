#include "core/models/pendulum_bounds.h"

#include <cmath>

#include "core/models/pendulum_kernel.h"
#include "core/numerics/wide.h"

namespace ricochet::pendulum {
namespace {

// The largest double not above `bound` that Solve accepts as admissible.
double LargestAdmissible(Problem problem, Law law, double bound) {
  problem.law = law;
  // Whether a coefficient is admissible does not depend on how fast the pendulum comes in.
  problem.omega_minus = -1.0;
  problem.coefficient = bound;
  while (Solve(problem).sharp_limit_broken) {
    problem.coefficient = std::nextafter(problem.coefficient, 0.0);
  }
  return problem.coefficient;
}

// [lower, upper] of mu_hat for b > 0, mirrored for b < 0.
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

CoefficientBounds SharpBounds(const Problem& problem, const Solution<Wide>& x, const Wide& tau0) {
  const Wide one(1.0);
  const Wide root = Sqrt(x.d / x.s);
  // (1 - x)(1 + x) = d s/a^2
  const Wide cosine = Sqrt(x.d * x.s) / x.a;
  const double mu = std::fabs(ToDouble(x.mu));
  const double tangential = ToDouble(Wide(mu) * (x.q / x.a) / (one + cosine));
  CoefficientBounds bounds;
  bounds.newton.upper = LargestAdmissible(problem, Law::kNewton, ToDouble(root));
  bounds.poisson.upper = LargestAdmissible(problem, Law::kPoisson, ToDouble(one / root));
  bounds.energetic.upper = 1.0;
  bounds.tangential = Signed(0.0 - tangential, mu, problem.b);
  bounds.normal_total_n_s = {ToDouble(tau0), ToDouble((one + one / root) * tau0)};
  return bounds;
}

CoefficientBounds EnergyOnlyBounds(const Problem& problem, const Solution<Wide>& x, const Wide& tau0) {
  const Wide two(2.0);
  const double mu = std::fabs(ToDouble(x.mu));
  CoefficientBounds bounds;
  bounds.newton.upper = 1.0;
  bounds.poisson.upper = ToDouble(x.s / x.d);
  bounds.energetic.upper = ToDouble(Sqrt(x.s / x.d));
  bounds.tangential = Signed(0.0 - ToDouble(Wide(mu) * x.q / x.a), mu, problem.b);
  bounds.normal_total_n_s = {ToDouble(tau0), ToDouble(two * x.a / x.d * tau0)};
  return bounds;
}

}  // namespace

Bounds SolveBounds(const Problem& problem) {
  Solution<Wide> x;
  SolveGeometry(problem, x);
  const bool separating = problem.omega_minus >= 0.0;
  const Wide tau0 = separating ? Wide() : x.inertia * -x.omega / x.s;
  Bounds bounds;
  bounds.regime = separating ? Regime::kSeparating : x.regime;
  bounds.friction_ratio = ToDouble(x.q / x.a);
  bounds.slope_ratio = ToDouble(x.d / x.s);
  if (x.regime == Regime::kLocked) {
    bounds.sharp = LockedBounds(problem, ToDouble(tau0));
    bounds.energy_only = bounds.sharp;
    return bounds;
  }
  bounds.sharp = SharpBounds(problem, x, tau0);
  bounds.energy_only = EnergyOnlyBounds(problem, x, tau0);
  return bounds;
}

}  // namespace ricochet::pendulum
