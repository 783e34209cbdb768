// Two bodies in a plane that strike each other, solved in this process: prints the velocities of both after the impact.

#include <iostream>

#include "ricochet/solver.h"

int main() {
  ricochet::Scene scene;
  scene.system = ricochet::BodyPair{ricochet::PlanarPair{
      .body_1 = {.mass_kg = 1, .inertia_com_kg_m2 = 0.1, .offset_n_m = -0.3, .velocity_t_m_s = 1, .velocity_n_m_s = -2},
      .body_2 = {.mass_kg = 2, .inertia_com_kg_m2 = 0.1, .offset_t_m = 0.2, .offset_n_m = 0.3}}};
  scene.friction.kinetic_coefficient = 0.4;
  scene.restitution = ricochet::EnergeticCoefficient{0.5};

  const ricochet::LocalSolver solver;
  const auto response = solver.Solve({.scene = scene});
  if (!response.ok()) {
    std::cerr << response.status().message() << '\n';
    return 1;
  }
  for (const ricochet::BodyVelocity& body : response->outcome.bodies_after) {
    std::cout << body.linear_m_s[0] << ' ' << body.linear_m_s[1] << ' ' << body.angular_rad_s[0] << '\n';
  }
}
