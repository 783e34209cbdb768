#include "core/models/pendulum/first_order.h"

#include <cstddef>

namespace ricochet::first_order {

Impact Solve(const Problem& problem) {
  const Approximation approximation = Approximate(problem);
  Impact impact;
  impact.regime = RegimeOf(problem);
  for (int i = 0; i < pendulum::kOutputCount; ++i) {
    impact.values[static_cast<size_t>(i)] = Value(problem, approximation, static_cast<Output>(i));
  }
  return impact;
}

Instant At(const Problem& problem, double tau) {
  const Approximation of = Approximate(problem);
  const double mu = SignedFriction(problem);
  if (tau <= of.tau0) {
    return {.omega = problem.omega_minus * ((of.tau0 - tau) / of.tau0) + 0.0, .tangential_impulse = mu * tau + 0.0};
  }
  const double tau1 = Value(problem, of, Output::kNormalImpulse);
  if (!(tau < tau1)) {
    return {.omega = Value(problem, of, Output::kOmegaPlus),
            .tangential_impulse = Value(problem, of, Output::kTangentialImpulse)};
  }
  return {.omega = of.omega_plus * ((tau - of.tau0) / (tau1 - of.tau0)),
          .tangential_impulse = mu * (of.tau0 - (tau - of.tau0)) + 0.0};
}

}  // namespace ricochet::first_order
