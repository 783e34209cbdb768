#include "tests/peers/exact.h"

#include <cstdlib>
#include <iostream>

#include "ricochet/solver.h"

namespace ricochet::peers {
namespace {

long double CertifiedOmega(const PendulumCase& c, const Restitution& restitution) {
  SolveRequest request{.scene = SceneOf(c), .certified_digits = 32};
  request.scene.restitution = restitution;
  const auto response = LocalSolver().Solve(request);
  if (response.ok() && response->outcome.certificate) {
    for (const CertifiedNumber& number : response->outcome.certificate->numbers) {
      // omega+ = -kappa_hat omega-.
      if (number.path == "coefficients.newton") return -kOmegaBefore * std::strtold(number.decimal.c_str(), nullptr);
    }
  }
  std::cerr << "case " << c.number << ": no exact answer: " << response.status() << '\n';
  std::exit(EXIT_FAILURE);
}

}  // namespace

Scene SceneOf(const PendulumCase& c) {
  Scene scene;
  scene.system = Pendulum{.inertia_kg_m2 = kInertiaAboutPin, .a_m = c.a, .b_m = c.b, .omega_minus_rad_s = kOmegaBefore};
  scene.friction.kinetic_coefficient = c.friction;
  scene.restitution = EnergeticCoefficient{c.restitution};
  return scene;
}

Exact ExactAnswers(const PendulumCase& c) {
  return {.newton = CertifiedOmega(c, NewtonCoefficient{c.restitution}),
          .poisson = CertifiedOmega(c, PoissonCoefficient{c.restitution}),
          .energetic = CertifiedOmega(c, EnergeticCoefficient{c.restitution})};
}

}  // namespace ricochet::peers
