#include "core/multi/energy.h"

#include <Eigen/LU>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>

#include "core/numerics/interval.h"

namespace ricochet::multi {
namespace {

// A row of W with no more than this part of its diagonal left depends on the rows before.
constexpr double kRankTolerance = 1e-13;
// A convex combination of rays this short, each scaled to a normal part of length 1, is 0 up to rounding.
constexpr double kJamTolerance = 1e-15;

// The ray of the cone of contact i that `moved` = W x parts least, scaled to a normal direction of length 1.
Eigen::VectorXd LeastParted(const Problem& problem, int i, const Eigen::VectorXd& moved) {
  const int d = problem.d;
  const double mu = problem.laws[At(i)].mu;
  Eigen::VectorXd ray = Eigen::VectorXd::Zero(moved.size());
  ray(problem.N(i)) = 1.0;
  const Eigen::VectorXd slip = moved.segment(problem.T(i), d - 1);
  const double speed = slip.norm();
  if (speed > 0.0) ray.segment(problem.T(i), d - 1) = -mu / speed * slip;
  if (speed == 0.0) ray(problem.T(i)) = -mu;
  return ray / std::sqrt(problem.w(problem.N(i), problem.N(i)));
}

}  // namespace

Eigen::VectorXd EnergyMetric::CoordinatesOf(const Eigen::VectorXd& v) const {
  Eigen::VectorXd coordinates(g.cols());
  for (Eigen::Index c = 0; c < coordinates.size(); ++c) {
    const int row = pivots[At(c)];
    coordinates(c) = (v(row) - g.row(row).head(c).dot(coordinates.head(c))) / g(row, c);
  }
  return coordinates;
}

Eigen::VectorXd EnergyMetric::ImpulseFor(const Eigen::VectorXd& direction) const {
  const auto rank = static_cast<Eigen::Index>(pivots.size());
  Eigen::VectorXd rest = direction;
  Eigen::VectorXd impulse = Eigen::VectorXd::Zero(g.rows());
  for (Eigen::Index c = rank; c-- > 0;) {
    const int row = pivots[At(c)];
    impulse(row) = rest(c) / g(row, c);
    rest -= impulse(row) * g.row(row).transpose();
  }
  return impulse;
}

EnergyMetric MetricOf(const Problem& problem) {
  const Eigen::Index size = problem.v.size();
  Eigen::MatrixXd g = Eigen::MatrixXd::Zero(size, size);
  Eigen::VectorXd left = problem.w.diagonal();
  EnergyMetric metric;
  for (Eigen::Index column = 0; column < size; ++column) {
    int pivot = -1;
    double largest = kRankTolerance;
    for (int i = 0; i < size; ++i) {
      const bool is_used = std::find(metric.pivots.begin(), metric.pivots.end(), i) != metric.pivots.end();
      const double share = problem.w(i, i) > 0.0 && !is_used ? left(i) / problem.w(i, i) : 0.0;
      if (share > largest) largest = share, pivot = i;
    }
    if (pivot < 0) break;
    const double root = std::sqrt(left(pivot));
    g.col(column) = (problem.w.col(pivot) - g.leftCols(column) * g.row(pivot).head(column).transpose()) / root;
    for (const int used : metric.pivots) g(used, column) = 0.0;
    left -= g.col(column).cwiseAbs2();
    metric.pivots.push_back(pivot);
  }
  const auto rank = static_cast<Eigen::Index>(metric.pivots.size());
  metric.g = g.leftCols(rank);
  metric.y = metric.CoordinatesOf(problem.v);
  metric.x = metric.ImpulseFor(metric.y);
  // sqrt(v . W+ v) <= sqrt(x . W x) + sqrt(r . W+ r) with the residual r = v - W x.
  Interval energy(0.0);
  Eigen::VectorXd residual(rank);
  for (Eigen::Index i = 0; i < size; ++i) {
    Interval moved(0.0);
    for (const int j : metric.pivots) moved = moved + Interval(problem.w(i, j)) * Interval(metric.x(j));
    energy = energy + Interval(metric.x(i)) * moved;
    const auto pivot = std::find(metric.pivots.begin(), metric.pivots.end(), static_cast<int>(i));
    if (pivot == metric.pivots.end()) continue;
    const Interval rest = Interval(problem.v(i)) - moved;
    residual(pivot - metric.pivots.begin()) = std::max(std::abs(rest.lower), std::abs(rest.upper));
  }
  const double of_residual = residual.cwiseQuotient(metric.g(metric.pivots, Eigen::all).diagonal()).sum();
  metric.root_energy =
      (Sqrt(AtLeast(energy, 0.0)) + Interval(4.0 * static_cast<double>(std::max<Eigen::Index>(rank, 1)) * of_residual))
          .upper;
  return metric;
}

// The shortest convex combination of the rays, by Wolfe's method: the angle of each ray with it is acute. It has no
// entries if it is 0 up to rounding, which grows with the squares of the coefficients of friction.
static Eigen::VectorXd ShortestPush(const Problem& problem) {
  constexpr int kMostRounds = 100;
  std::vector<Eigen::VectorXd> rays;
  std::vector<double> weights;
  Eigen::VectorXd x = Eigen::VectorXd::Zero(problem.v.size());
  for (int i = 0; i < problem.k; ++i) {
    if (problem.w(problem.N(i), problem.N(i)) == 0.0) return {};
  }
  for (int round = 0; round < kMostRounds; ++round) {
    const Eigen::VectorXd moved = problem.w * x;
    const double square = x.dot(moved);
    double least = std::numeric_limits<double>::infinity();
    Eigen::VectorXd ray;
    for (int i = 0; i < problem.k; ++i) {
      const Eigen::VectorXd own = LeastParted(problem, i, moved);
      if (own.dot(moved) < least) least = own.dot(moved), ray = own;
    }
    if (!rays.empty() && least > 0.125 * square && square > kJamTolerance) return x;
    if (!rays.empty() && square <= kJamTolerance) return {};
    rays.push_back(ray);
    weights.push_back(rays.size() == 1 ? 1.0 : 0.0);
    // The shortest affine combination of the rays kept; those whose weight would be negative leave.
    for (;;) {
      const auto count = static_cast<Eigen::Index>(rays.size());
      Eigen::MatrixXd system = Eigen::MatrixXd::Zero(count + 1, count + 1);
      for (Eigen::Index a = 0; a < count; ++a) {
        system(a, count) = system(count, a) = 1.0;
        for (Eigen::Index b = 0; b < count; ++b) {
          system(a, b) = rays[At(a)].dot(problem.w * rays[At(b)]);
        }
      }
      Eigen::VectorXd right = Eigen::VectorXd::Zero(count + 1);
      right(count) = 1.0;
      const Eigen::VectorXd wanted = system.fullPivLu().solve(right);
      double step = 1.0;
      for (Eigen::Index a = 0; a < count; ++a) {
        const double now = weights[At(a)];
        if (wanted(a) <= 0.0 && now > wanted(a)) step = std::min(step, now / (now - wanted(a)));
      }
      for (size_t a = 0; a < weights.size(); ++a) {
        weights[a] += step * (wanted(static_cast<Eigen::Index>(a)) - weights[a]);
      }
      if (step == 1.0) break;
      for (size_t a = weights.size(); a-- > 0;) {
        if (weights[a] > 1e-12 || rays.size() == 1) continue;
        weights.erase(weights.begin() + static_cast<std::ptrdiff_t>(a));
        rays.erase(rays.begin() + static_cast<std::ptrdiff_t>(a));
      }
    }
    x.setZero();
    for (size_t a = 0; a < rays.size(); ++a) x += weights[a] * rays[a];
  }
  return {};
}

// An impulse that gives the contacts no slip, so that friction of any size stays out of it, and by least squares normal
// velocities that are nearly equal in the metric of energy. It has no entries if it does not part all contacts.
static Eigen::VectorXd PushWithoutSlip(const Problem& problem, const EnergyMetric& metric) {
  const Eigen::Index k = problem.k, d = problem.d, rank = metric.g.cols();
  if (rank == 0) return {};
  Eigen::MatrixXd slip(k * (d - 1), rank), normal(k, rank);
  for (int i = 0; i < problem.k; ++i) {
    slip.middleRows(i * (d - 1), d - 1) = metric.g.middleRows(problem.T(i), d - 1).rowwise().normalized();
    normal.row(i) = metric.g.row(problem.N(i)).normalized();
  }
  const Eigen::MatrixXd still = slip.fullPivLu().kernel();
  const Eigen::VectorXd parts = (normal * still).fullPivHouseholderQr().solve(Eigen::VectorXd::Ones(k));
  Eigen::VectorXd push = metric.ImpulseFor(still * parts);
  const Eigen::VectorXd moved = problem.w * push;
  const Eigen::VectorXd rounding =
      2.0 * static_cast<double>(push.size()) * kEpsilon * (problem.w.cwiseAbs() * push.cwiseAbs());
  for (int i = 0; i < problem.k; ++i) {
    const double slips = moved.segment(problem.T(i), d - 1).norm() + rounding.segment(problem.T(i), d - 1).norm();
    const double needed = problem.laws[At(i)].mu * slips + rounding(problem.N(i));
    if (!(moved(problem.N(i)) > needed)) return {};
  }
  return push;
}

Eigen::VectorXd PushApart(const Problem& problem, const EnergyMetric& metric) {
  const Eigen::VectorXd shortest = ShortestPush(problem);
  return shortest.size() > 0 ? shortest : PushWithoutSlip(problem, metric);
}

}  // namespace ricochet::multi
