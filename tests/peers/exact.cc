#include "tests/peers/exact.h"

#include <cstdlib>
#include <fstream>
#include <iostream>
#include <nlohmann/json.hpp>

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

std::vector<PendulumCase> ReadPendulumCases(const std::string& impacts_file) {
  std::ifstream file(impacts_file);
  const nlohmann::json impacts = nlohmann::json::parse(file);
  std::vector<PendulumCase> cases;
  for (const nlohmann::json& one : impacts["cases"]) {
    const std::string name = one["name"];
    const int number = static_cast<int>(cases.size()) + 1;
    if (name.rfind("pendulum-" + std::to_string(number) + "-", 0) != 0) continue;
    cases.push_back({.number = number,
                     .a = one["jacobian"][1][0],
                     .b = one["jacobian"][0][0],
                     .friction = one["contacts"][0]["friction"],
                     .restitution = one["contacts"][0]["coefficient"]});
  }
  if (cases.size() == 5) return cases;
  std::cerr << impacts_file << " has " << cases.size() << " of the cases pendulum-1 to pendulum-5\n";
  std::exit(EXIT_FAILURE);
}

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
