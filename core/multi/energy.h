// EnergyMetric: W = G G^T, the contact velocity as v = G y, and the impulses that only push apart.
//
// |y|^2 is twice the least kinetic energy that goes with v. G has as many columns as W has rank, up to rounding:
// entries are accurate to some 10 eps times the condition of the rows that are not rounding. Nothing that is proved
// relies on G or on the rank.

#ifndef RICOCHET_CORE_MULTI_ENERGY_H_
#define RICOCHET_CORE_MULTI_ENERGY_H_

#include <Eigen/Core>
#include <vector>

#include "core/multi/problem.h"

namespace ricochet::multi {

struct EnergyMetric {
  Eigen::MatrixXd g;         // kd x rank
  std::vector<int> pivots;   // Rows of G that are independent: in this order they are lower triangular.
  Eigen::VectorXd y;         // v = G y
  Eigen::VectorXd x;         // v = W x, up to rounding; only pivots are not 0.
  double root_energy = 0.0;  // An upper bound of sqrt(v . W+ v).

  // The y for which G y has the entries of `v` at the pivots.
  Eigen::VectorXd CoordinatesOf(const Eigen::VectorXd& v) const;
  // The impulse at the pivots for which G^T times it is `direction`.
  Eigen::VectorXd ImpulseFor(const Eigen::VectorXd& direction) const;
};

EnergyMetric MetricOf(const Problem& problem);

// An impulse pi with (W pi)_n > mu |(W pi)_t| at every contact: it pushes all contacts apart whatever they do by
// friction. It has no entries if there is none, up to rounding; then impulses within the cones exist that move nothing,
// and the contacts may jam.
Eigen::VectorXd PushApart(const Problem& problem, const EnergyMetric& metric);

}  // namespace ricochet::multi

#endif  // RICOCHET_CORE_MULTI_ENERGY_H_
