// A program that uses Eigen and mechanisms, solved in this process: prints their rates after the impact, to the last
// bit. It factorizes matrices of its own as Ricochet does, so that both call the same functions of Eigen.

#include "ricochet/eigen.h"

#include <Eigen/Dense>
#include <cmath>
#include <cstdio>

#include "ricochet/solver.h"

namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr Eigen::Index kSize = 9;

double Number(Eigen::Index i, Eigen::Index j) { return std::sin(static_cast<double>((i + 1) * (j + 2))); }

// The product with 0.5 is exact, so that fused and separate operations give the same rounded rates.
ricochet::Mechanism MechanismOf(int seed, const MatrixXd& mass) {
  const MatrixXd jacobian = MatrixXd::NullaryExpr(3, kSize, [seed](auto i, auto j) { return Number(i + seed, j); });
  const VectorXd rates = 0.5 * jacobian.row(0) - jacobian.row(2);
  return *ricochet::MechanismFrom(mass, jacobian, rates);
}

}  // namespace

int main() {
  ricochet::Scene scene;
  scene.friction.kinetic_coefficient = 0.3;
  scene.restitution = ricochet::EnergeticCoefficient{0.5};
  const ricochet::LocalSolver solver;
  for (int seed = 0; seed < 100; ++seed) {
    const MatrixXd mass = MatrixXd::NullaryExpr(kSize, kSize, [seed](auto i, auto j) {
      return i == j ? 11.0 : 0.3 * (Number(i + seed, j) + Number(j + seed, i));
    });
    const Eigen::LLT<MatrixXd> own(mass);
    if (!own.solve(mass).allFinite() || !own.matrixL().solve(mass).colwise().norm().allFinite()) return 1;
    scene.system = MechanismOf(seed, mass);
    const auto response = solver.Solve({.scene = scene});
    if (!response.ok()) {
      std::puts(response.status().ToString().c_str());
      return 1;
    }
    for (const double rate : ricochet::RatesAfter(response->outcome)) std::printf("%a\n", rate);
  }
}
