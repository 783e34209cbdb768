// The paper's pendulum, solved in this process.

#include <iostream>

#include "ricochet/solver.h"

int main() {
  ricochet::Scene scene;
  scene.system = ricochet::Pendulum{.inertia_kg_m2 = 1.0, .a_m = 0.3, .b_m = 1.0, .omega_minus_rad_s = -1.0};
  scene.friction.kinetic_coefficient = 0.1;
  scene.restitution = ricochet::EnergeticCoefficient{1.0};

  const ricochet::LocalSolver solver;
  const auto response = solver.Solve({.scene = scene});
  if (!response.ok()) {
    std::cerr << response.status() << '\n';
    return 1;
  }
  const ricochet::Coefficients& coefficients = response->outcome.coefficients;
  std::cout << "Newton " << coefficients.newton << ", Poisson " << coefficients.poisson << '\n';
}
