#include "core/bounds/pendulum_bounds.h"

#include <cmath>

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

}  // namespace ricochet::pendulum
