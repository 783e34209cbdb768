#include "core/multi/spring_tail.h"

#include <Eigen/LU>
#include <algorithm>
#include <limits>
#include <vector>

namespace ricochet::multi {
namespace {

// The least P.B P over all P >= 0 that add up to 1; at least a lower bound of it.
double LeastOnSimplex(const Eigen::MatrixXd& b) {
  const auto k = static_cast<int>(b.rows());
  if (k > kMostContactsInOrders) return b.minCoeff();
  double least = std::numeric_limits<double>::infinity();
  for (int set = 1; set < 1 << k; ++set) {
    std::vector<int> members;
    for (int i = 0; i < k; ++i) {
      if ((set >> i & 1) != 0) members.push_back(i);
    }
    const auto size = static_cast<Eigen::Index>(members.size());
    const Eigen::FullPivLU<Eigen::MatrixXd> lu(b(members, members));
    if (!lu.isInvertible()) continue;
    const Eigen::VectorXd x = lu.solve(Eigen::VectorXd::Ones(size));
    if ((x * x.sum()).minCoeff() >= 0.0) least = std::min(least, 1.0 / x.sum());
  }
  return least;
}

}  // namespace

double BetaOf(const Problem& problem) {
  Eigen::MatrixXd b(problem.k, problem.k);
  const auto drag = [&problem](int i, int j) { return problem.laws[At(j)].mu * std::abs(problem.w(2 * i + 1, 2 * j)); };
  for (int i = 0; i < problem.k; ++i) {
    for (int j = 0; j < problem.k; ++j) {
      b(i, j) = problem.w(2 * i + 1, 2 * j + 1) - std::max(drag(i, j), drag(j, i));
    }
  }
  // This subtracts a bound on the rounding of B and of the search.
  return LeastOnSimplex(b) - 64.0 * kEpsilon * b.cwiseAbs().maxCoeff();
}

}  // namespace ricochet::multi
