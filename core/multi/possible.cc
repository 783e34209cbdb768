#include "core/multi/possible.h"

#include <algorithm>
#include <array>
#include <limits>

#include "core/multi/dual_bound.h"
#include "core/multi/dual_search.h"
#include "core/multi/faces.h"
#include "core/numerics/interval.h"

namespace ricochet::multi {
namespace {

// A bound this close to the maximum on a face, over its scale, needs no search.
constexpr double kCloseEnough = 1e-9;

// Bounds on gamma . v.
Range ProductOf(const Eigen::VectorXd& gamma, const Eigen::VectorXd& v) {
  Interval sum(0.0);
  for (Eigen::Index i = 0; i < v.size(); ++i) sum = sum + Interval(gamma(i)) * Interval(v(i));
  return {.lower = sum.lower, .upper = sum.upper};
}

}  // namespace

std::vector<Range> FindPossible(const Problem& problem, const EnergyMetric& metric, const Eigen::VectorXd& apart,
                                const std::vector<Eigen::VectorXd>& gammas, absl::FunctionRef<bool()> stopped) {
  // Where no contact parts more slowly than it slides times friction, an impulse that changes anything adds energy.
  if (LeastParting(problem, problem.v) >= 0.0) {
    std::vector<Range> unchanged;
    for (const Eigen::VectorXd& gamma : gammas) unchanged.push_back(ProductOf(gamma, problem.v));
    return unchanged;
  }
  std::vector<Maximum> maxima(2 * gammas.size());
  if (problem.d == 2 && problem.k <= kMostContactsOfFaces) maxima = MaximaOnFaces(problem, metric, gammas);
  std::vector<Range> ranges;
  for (size_t f = 0; f < gammas.size() && !stopped(); ++f) {
    std::array<double, 2> bounds;
    for (size_t side = 0; side < 2; ++side) {
      const Maximum& maximum = maxima[2 * f + side];
      const Eigen::VectorXd gamma = side == 0 ? gammas[f] : Eigen::VectorXd(-gammas[f]);
      double& bound = bounds[side];
      bound = std::numeric_limits<double>::infinity();
      const auto prove = [&](const DualPoint& point) {
        bound = std::min(bound, DualBound(problem, metric.root_energy, apart, gamma, point));
      };
      for (const DualPoint& proof : maximum.proofs) prove(proof);
      const double scale = metric.root_energy * (metric.g.transpose() * gamma).norm();
      if (!maximum.proofs.empty() && bound <= maximum.value + kCloseEnough * scale) continue;
      prove(MinimiseDual(problem, metric, apart, gamma, stopped));
    }
    ranges.push_back({.lower = -bounds[1], .upper = bounds[0]});
  }
  return ranges;
}

}  // namespace ricochet::multi
