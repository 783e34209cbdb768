// The errors of the numbers of a pendulum's impact (core/models/pendulum/pendulum.h,
// core/models/pendulum/first_order.h).
#include <cmath>

#include "core/models/pendulum/first_order.h"
#include "core/models/pendulum/pendulum.h"

namespace ricochet::pendulum {
namespace {

constexpr double kSmallest = 0x1p-1074;

// Counts of roundings: of each number itself, and of a number that changes its sign on the scale on which it does.
struct Counts {
  double coefficient, velocity, tau_compression, tau;
  double work_compression, work_restitution;
  double kappa, one_minus_kappa;  // f1 errs by these times kappa and |1 - kappa|, over mu tau0
};

// A coefficient that the law states is exact.
void SetStatedCoefficient(RestitutionLaw law, ImpactErrors& errors) {
  if (law == RestitutionLaw::kNewton) errors.newton = 0.0;
  if (law == RestitutionLaw::kPoisson) errors.poisson = 0.0;
  if (law == RestitutionLaw::kEnergetic) errors.energetic = 0.0;
}

// Errors of a number below the range of products, over the scale of its kind.
ImpactErrors ErrorsBy(const Counts& counts, double unit, double unseen, double energy, const Problem& problem,
                      const Impact& impact) {
  if (impact.regime == Regime::kSeparating) {
    ImpactErrors errors = NoErrors();
    errors.u = 0x1p-53 * std::fabs(impact[Output::kTangentialVelocityAfter]) + kSmallest;
    errors.v = 0x1p-53 * std::fabs(impact[Output::kNormalVelocityAfter]) + kSmallest;
    return errors;
  }
  const auto of = [&](double count, Output output, double scale) {
    return unit * count * std::fabs(impact[output]) + (unseen > 0.0 ? unseen * scale : 0.0) + kSmallest;
  };
  const double kappa = impact[Output::kPoisson];
  const double friction = std::fabs(impact[Output::kTangentialImpulseCompression]);
  const double work_n = std::fabs(impact[Output::kWorkNormalCompression]);
  const double work_t = std::fabs(impact[Output::kWorkTangentialCompression]);
  const double eta = impact[Output::kEnergetic];
  const double returned = 1.0 + eta * eta;
  const double of_friction = unit * (counts.kappa * kappa + counts.one_minus_kappa * std::fabs(1.0 - kappa));
  const double mu = problem.b == 0.0 ? 0.0 : problem.mu;
  ImpactErrors errors;
  errors.newton = of(counts.coefficient, Output::kNewton, 1.0);
  errors.poisson = of(counts.coefficient, Output::kPoisson, 1.0);
  errors.energetic = of(counts.coefficient, Output::kEnergetic, 1.0);
  errors.tangential =
      of_friction * mu / (1.0 + kappa) + unit * 6.0 * std::fabs(impact[Output::kTangentialCoefficient]) + kSmallest;
  errors.u = of(counts.velocity, Output::kTangentialVelocityAfter, std::fabs(problem.b * problem.omega_minus));
  errors.v = of(counts.velocity, Output::kNormalVelocityAfter, std::fabs(problem.a * problem.omega_minus));
  errors.tau_compression = of(counts.tau_compression, Output::kNormalImpulseCompression, 0.0);
  errors.tau = of(counts.tau, Output::kNormalImpulse, 0.0);
  // The loss where an impulse or a work of compression is below the range of doubles grows with kappa.
  errors.f = of_friction * friction + kSmallest * (1.0 + impact[Output::kNormalImpulse] + kappa);
  errors.work_normal_compression = of(counts.work_compression, Output::kWorkNormalCompression, 0.0);
  errors.work_normal_restitution = of(counts.work_restitution, Output::kWorkNormalRestitution, work_n);
  errors.work_tangential_compression = of(counts.work_compression, Output::kWorkTangentialCompression, work_n);
  // A product of a large coefficient with a work below the range of doubles is unknown.
  errors.work_tangential_restitution =
      KnownError(of(counts.work_restitution, Output::kWorkTangentialRestitution, returned * (work_n + work_t)));
  errors.energy_change = KnownError(energy * returned * (work_n + work_t) +
                                    unit * 4.0 * std::fabs(impact[Output::kEnergyChange]) + kSmallest);
  SetStatedCoefficient(problem.law, errors);
  if (impact.regime == Regime::kLocked || problem.coefficient == 0.0) {
    errors.newton = errors.poisson = errors.energetic = 0.0;
  }
  return errors;
}

}  // namespace

// Each number is within 1 ulp, and one that changes its sign within 2^-100 of its scale besides.
ImpactErrors ErrorsOf(const Problem& problem, const Impact& impact) {
  constexpr double kOfScale = 0x1p-99;
  constexpr Counts kUlps = {1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 0x1p-46, 1.0};
  return ErrorsBy(kUlps, 0x1p-52, 0.0, kOfScale, problem, impact);
}

ImpactErrors PlainErrorsOf(const Problem& problem, const PlainImpact& plain) {
  constexpr double kUnit = 1.02 * 0x1p-53;
  constexpr double kUnseen = 0x1p-750;
  constexpr Counts kRoundings = {8.5, 9.0, 6.0, 15.0, 9.0, 19.0, 3.0, 23.0};
  return ErrorsBy(kRoundings, kUnit, kUnseen, plain.relative_error, problem, plain.impact);
}

}  // namespace ricochet::pendulum

namespace ricochet::first_order {

ImpactErrors NumberErrorsOf(const Problem& problem, const Impact& impact) {
  constexpr double kEps = 0x1p-53;
  constexpr double kEnlarged = 1.0 + 0x1p-40;
  using pendulum::kSmallest;
  if (!AreModerate({problem.inertia, problem.a, problem.b, problem.omega_minus, problem.mu, problem.coefficient},
                   0x1p100)) {
    return {};
  }
  const double x = FrictionRatio(problem);
  const auto forms = pendulum::CoefficientForms(problem.law, problem.coefficient, x, 1.0 - x, 1.0 + x);
  const double newton = kEnlarged * forms.newton.error;
  const double poisson = kEnlarged * forms.poisson.error;
  const double kappa = impact[Output::kPoisson];
  const double kappa_hat = impact[Output::kNewton];
  const double mu = std::fabs(SignedFriction(problem));
  const double tau0 = impact[Output::kNormalImpulseCompression];
  const double energy = 0.5 * problem.inertia * problem.omega_minus * problem.omega_minus;
  const double of_square = energy * (2.0 * kappa_hat + newton) * newton;
  const auto of = [&](double count, Output output) { return kEps * count * std::fabs(impact[output]) + kSmallest; };
  ImpactErrors errors;
  errors.newton = newton + of(10.0, Output::kNewton);
  errors.poisson = poisson + of(10.0, Output::kPoisson);
  errors.energetic = kEnlarged * forms.energetic.error + of(10.0, Output::kEnergetic);
  errors.tangential = mu * (kEnlarged * forms.tangential.error + 32.0 * kEps) + kSmallest;
  errors.u = std::fabs(problem.b * problem.omega_minus) * newton + of(12.0, Output::kTangentialVelocityAfter);
  errors.v = problem.a * -problem.omega_minus * newton + of(12.0, Output::kNormalVelocityAfter);
  errors.tau_compression = of(6.0, Output::kNormalImpulseCompression);
  errors.tau = tau0 * poisson + of(14.0, Output::kNormalImpulse);
  errors.f = mu * tau0 * (poisson + 16.0 * kEps * (1.0 + kappa)) + kSmallest;
  errors.work_normal_compression = of(12.0, Output::kWorkNormalCompression);
  errors.work_tangential_compression = of(16.0, Output::kWorkTangentialCompression);
  errors.work_normal_restitution = of_square / (1.0 - x) * kEnlarged + of(32.0, Output::kWorkNormalRestitution);
  errors.work_tangential_restitution =
      x * of_square / (1.0 - x) * kEnlarged + of(36.0, Output::kWorkTangentialRestitution);
  errors.energy_change = of_square + 32.0 * kEps * energy * (1.0 + kappa_hat * kappa_hat) + kSmallest;
  pendulum::SetStatedCoefficient(problem.law, errors);
  if (mu == 0.0) errors.newton = errors.poisson = errors.energetic = errors.tangential = errors.f = 0.0;
  return errors;
}

}  // namespace ricochet::first_order
