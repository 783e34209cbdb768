// A client alone: asks the server at the address that it is given for one impact, and prints Newton's coefficient or
// why there is none. Nothing of the engine is linked.

#include "ricochet/client.h"

#include <iostream>

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  const auto client = ricochet::Client::Connect({.target = argv[1], .retry = {.max_attempts = 1}});
  if (!client.ok()) {
    std::cerr << client.status() << '\n';
    return 1;
  }
  ricochet::SolveRequest request;
  request.scene.system = ricochet::Pendulum{.inertia_kg_m2 = 1.0, .a_m = 0.3, .b_m = 1.0, .omega_minus_rad_s = -1.0};
  request.scene.restitution = ricochet::EnergeticCoefficient{1.0};
  request.scene.friction.kinetic_coefficient = 0.1;
  const auto response = client->Solve(request);
  if (!response.ok()) {
    std::cout << absl::StatusCodeToString(response.status().code()) << '\n';
  } else {
    std::cout << response->outcome.coefficients.newton << '\n';
  }
}
