#include "core/multi/dual_search.h"

#include <Eigen/Cholesky>
#include <limits>
#include <vector>

#include "core/numerics/elementary.h"

namespace ricochet::multi {
namespace {

// The barrier's weight falls by this factor from step to step of the path.
constexpr double kFactor = 0.05;
// The path ends where the barrier moves the bound by no more than this part of its scale.
constexpr double kLast = 1e-13;
constexpr int kMostSteps = 30;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

// c = rows x + shift lies in a second order cone: its last entry is larger than the norm of the others times `slope`.
struct Cone {
  Eigen::MatrixXd rows;
  Eigen::VectorXd shift;
  double slope = 1.0;
};

// The dual problem in x = (nu, a, s), where a are the entries of pi at the pivots of the metric: minimise
// sqrt(2T) s - a . v with s > |G^T (gamma + sum nu n + pi)|, each nu > 0, and W pi in its cone at each contact.
class Barrier {
 public:
  Barrier(const Problem& problem, const EnergyMetric& metric, bool has_pi, const Eigen::VectorXd& gamma)
      : contacts_(problem.k) {
    const auto rank = static_cast<Eigen::Index>(metric.pivots.size());
    const Eigen::Index free = has_pi ? rank : 0;
    const Eigen::Index size = problem.k + free + 1;
    const Eigen::MatrixXd of_pivots = metric.g(metric.pivots, Eigen::all).topRows(free);
    Cone& energy = cones_.emplace_back(
        Cone{.rows = Eigen::MatrixXd::Zero(rank + 1, size), .shift = Eigen::VectorXd::Zero(rank + 1)});
    energy.shift.head(rank) = metric.g.transpose() * gamma;
    for (int i = 0; i < problem.k; ++i) energy.rows.col(i).head(rank) = metric.g.row(problem.N(i));
    energy.rows.block(0, problem.k, rank, free) = of_pivots.transpose();
    energy.rows(rank, size - 1) = 1.0;
    for (int i = 0; has_pi && i < problem.k; ++i) {
      Cone& cone = cones_.emplace_back(Cone{.rows = Eigen::MatrixXd::Zero(problem.d, size),
                                            .shift = Eigen::VectorXd::Zero(problem.d),
                                            .slope = problem.laws[static_cast<size_t>(i)].mu});
      cone.rows.middleCols(problem.k, free) = metric.g.middleRows(problem.T(i), problem.d) * of_pivots.transpose();
    }
    linear_ = Eigen::VectorXd::Zero(size);
    linear_.segment(problem.k, free) = -problem.v(metric.pivots).head(free);
    linear_(size - 1) = metric.y.norm();
  }

  Eigen::Index size() const { return linear_.size(); }

  // The function plus `weight` times the barrier, which is infinite outside. Its derivatives are set unless null.
  double At(const Eigen::VectorXd& x, double weight, Eigen::VectorXd* gradient, Eigen::MatrixXd* hessian) const {
    double value = linear_.dot(x);
    if (gradient != nullptr) *gradient = linear_;
    if (hessian != nullptr) *hessian = Eigen::MatrixXd::Zero(size(), size());
    for (int i = 0; i < contacts_; ++i) {
      if (!(x(i) > 0.0)) return kInfinity;
      value -= weight * Log(x(i));
      if (gradient == nullptr) continue;
      (*gradient)(i) -= weight / x(i);
      (*hessian)(i, i) += weight / (x(i) * x(i));
    }
    for (const Cone& cone : cones_) {
      const Eigen::VectorXd c = cone.rows * x + cone.shift;
      const Eigen::Index last = c.size() - 1;
      // The product of two factors does not cancel.
      const double norm = cone.slope * c.head(last).norm();
      const double square = (c(last) - norm) * (c(last) + norm);
      if (!(c(last) > norm)) return kInfinity;
      value -= weight * Log(square);
      if (gradient == nullptr) continue;
      Eigen::VectorXd signs = Eigen::VectorXd::Constant(last + 1, -cone.slope * cone.slope);
      signs(last) = 1.0;
      const Eigen::VectorXd slope = cone.rows.transpose() * (signs.asDiagonal() * c) * (2.0 / square);
      *gradient -= weight * slope;
      *hessian += weight * (slope * slope.transpose() -
                            (2.0 / square) * (cone.rows.transpose() * signs.asDiagonal() * cone.rows));
    }
    return value;
  }

 private:
  int contacts_;
  std::vector<Cone> cones_;
  Eigen::VectorXd linear_;
};

// Newton's method for one weight.
void Centre(const Barrier& barrier, double weight, Eigen::VectorXd& x) {
  Eigen::VectorXd gradient;
  Eigen::MatrixXd hessian;
  for (int step = 0; step < kMostSteps; ++step) {
    const double value = barrier.At(x, weight, &gradient, &hessian);
    const Eigen::VectorXd change = -hessian.ldlt().solve(gradient);
    const double drop = -gradient.dot(change);
    if (!(drop > 1e-2 * weight)) return;
    double length = 1.0;
    while (!(barrier.At(x + length * change, weight, nullptr, nullptr) <= value - 0.1 * length * drop)) {
      length *= 0.5;
      if (length < 1e-9) return;
    }
    x += length * change;
  }
}

}  // namespace

DualPoint MinimiseDual(const Problem& problem, const EnergyMetric& metric, const Eigen::VectorXd& apart,
                       const Eigen::VectorXd& gamma, absl::FunctionRef<bool()> stopped) {
  const bool has_pi = apart.size() > 0;
  const Barrier barrier(problem, metric, has_pi, gamma);
  const auto rank = static_cast<Eigen::Index>(metric.pivots.size());
  const double length = (metric.g.transpose() * gamma).norm();
  DualPoint point = {.nu = Eigen::VectorXd::Zero(problem.k), .pi = Eigen::VectorXd::Zero(gamma.size())};
  if (!(length > 0.0)) return point;
  Eigen::VectorXd x = Eigen::VectorXd::Constant(barrier.size(), length);
  double norm = 0.0;
  for (int i = 0; i < problem.k; ++i) norm += metric.g.row(problem.N(i)).norm();
  if (has_pi) {
    const Eigen::VectorXd start = metric.g.transpose() * apart;
    x.segment(problem.k, rank) = metric.ImpulseFor(start * (length / start.norm()))(metric.pivots);
  }
  x(barrier.size() - 1) = (3.0 + norm) * length;
  const double scale = metric.y.norm() * length;
  for (double weight = scale; weight > kLast * scale && !stopped(); weight *= kFactor) Centre(barrier, weight, x);
  point.nu = x.head(problem.k);
  if (has_pi) point.pi(metric.pivots) = x.segment(problem.k, rank);
  return point;
}

}  // namespace ricochet::multi
