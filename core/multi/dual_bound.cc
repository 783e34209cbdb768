#include "core/multi/dual_bound.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/numerics/interval.h"

namespace ricochet::multi {
namespace {

using Intervals = std::array<Interval, size_t{3} * kMostContacts>;

Intervals Times(const Eigen::MatrixXd& w, const Eigen::VectorXd& x) {
  Intervals product;
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    Interval& sum = product[At(i)];
    for (Eigen::Index j = 0; j < x.size(); ++j) {
      if (x(j) != 0.0 && w(i, j) != 0.0) sum = sum + Interval(w(i, j)) * Interval(x(j));
    }
  }
  return product;
}

double LeastParting(const Problem& problem, const Intervals& moved) {
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i < problem.k; ++i) {
    const Interval mu(problem.laws[At(i)].mu);
    const size_t t = At(problem.T(i));
    const Interval slip = problem.d == 2 ? Abs(moved[t]) : Sqrt(Square(moved[t]) + Square(moved[t + 1]));
    least = std::min(least, (moved[At(problem.N(i))] - mu * slip).lower);
  }
  return least;
}

}  // namespace

double LeastParting(const Problem& problem, const Eigen::VectorXd& v) {
  Intervals exact;
  for (Eigen::Index i = 0; i < v.size(); ++i) exact[At(i)] = Interval(v(i));
  return LeastParting(problem, exact);
}

double DualBound(const Problem& problem, double root_energy, const Eigen::VectorXd& apart, const Eigen::VectorXd& gamma,
                 const DualPoint& point) {
  const Eigen::Index size = gamma.size();
  Eigen::VectorXd pi = point.pi;
  const double least = LeastParting(problem, Times(problem.w, pi));
  if (!(least >= 0.0)) {
    const double parting = apart.size() > 0 ? LeastParting(problem, Times(problem.w, apart)) : 0.0;
    const double rounding = kEpsilon * (problem.w.cwiseAbs() * pi.cwiseAbs()).maxCoeff();
    double push = parting > 0.0 ? std::max(-least, rounding) / parting : 0.0;
    bool is_inside = false;
    for (int doubling = 0; doubling < 6 && parting > 0.0 && !is_inside; ++doubling) {
      push *= 2.0;
      pi = point.pi + push * apart;
      is_inside = LeastParting(problem, Times(problem.w, pi)) >= 0.0;
    }
    if (!is_inside) pi.setZero();
  }
  Eigen::VectorXd nearest = pi + gamma;
  for (int i = 0; i < problem.k; ++i) nearest(problem.N(i)) += std::max(point.nu(i), 0.0);
  // The rounding error of the sum is as small as the sum, and its square is counted by the triangle inequality.
  const Intervals moved = Times(problem.w, nearest);
  Interval square(0.0), linear(0.0);
  double rest = 0.0;
  for (Eigen::Index i = 0; i < size; ++i) {
    square = square + Interval(nearest(i)) * moved[At(i)];
    linear = linear + Interval(pi(i)) * Interval(problem.v(i));
    const double terms = std::abs(pi(i)) + std::abs(gamma(i)) + std::abs(nearest(i));
    rest += 2.0 * kEpsilon * terms * std::sqrt(problem.w(i, i));
  }
  const Interval norm = Sqrt(AtLeast(square, 0.0)) + Interval(rest);
  return (Interval(root_energy) * norm - linear).upper;
}

}  // namespace ricochet::multi
