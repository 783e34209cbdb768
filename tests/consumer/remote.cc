// A sweep over friction, in this process or, with an address as argument, on a server: the same code, the same bits.

#include <iostream>
#include <memory>

#include "ricochet/client.h"
#include "ricochet/solver.h"

namespace {

absl::StatusOr<std::unique_ptr<ricochet::Solver>> MakeSolver(int argc, char** argv) {
  if (argc < 2) return std::make_unique<ricochet::LocalSolver>();
  auto client = ricochet::Client::Connect({.target = argv[1]});
  if (!client.ok()) return client.status();
  return std::make_unique<ricochet::Client>(*client);
}

absl::Status PrintNewton(const ricochet::Solver& solver) {
  ricochet::SweepRequest request;
  request.grid.scene.system =
      ricochet::Pendulum{.inertia_kg_m2 = 1.0, .a_m = 0.3, .b_m = 1.0, .omega_minus_rad_s = -1.0};
  request.grid.scene.restitution = ricochet::EnergeticCoefficient{1.0};
  request.grid.axes = {{"friction.kinetic_coefficient", ricochet::Linspace{0.0, 0.3, 4}}};
  request.columns = {"coefficients.newton"};
  for (const auto& chunk : solver.Sweep(request)) {
    if (!chunk.ok()) return chunk.status();
    for (const double newton : chunk->values) std::cout << newton << '\n';
  }
  return absl::OkStatus();
}

}  // namespace

int main(int argc, char** argv) {
  const auto solver = MakeSolver(argc, argv);
  const absl::Status status = solver.ok() ? PrintNewton(**solver) : solver.status();
  if (status.ok()) return 0;
  std::cerr << status << '\n';
  return 1;
}
