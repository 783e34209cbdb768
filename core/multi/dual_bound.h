// DualBound: a proved upper bound of a linear function of the velocity after, over all outcomes that are possible.
//
//   gamma . v+  <=  sqrt(2T) |gamma + sum nu_i n_i + pi|_W  -  pi . v-,    2T = v- . W+ v-,   |x|_W^2 = x . W x
//
// for any nu >= 0 and any pi with (W pi)_n >= mu |(W pi)_t| at every contact. It follows from v_n+ >= 0, from impulses
// within the cones of friction, and from energy that does not rise (docs/theory/several_contacts.md). The bound is
// evaluated with directed rounding, so that it holds whatever the arithmetic that found nu and pi.

#ifndef RICOCHET_CORE_MULTI_DUAL_BOUND_H_
#define RICOCHET_CORE_MULTI_DUAL_BOUND_H_

#include <Eigen/Core>

#include "core/multi/problem.h"

namespace ricochet::multi {

struct DualPoint {
  Eigen::VectorXd nu;  // k numbers; negative ones count as 0
  Eigen::VectorXd pi;  // kd numbers
};

// The least of v_n - mu |v_t| over all contacts, or less by rounding.
double LeastParting(const Problem& problem, const Eigen::VectorXd& v);

// `root_energy` bounds sqrt(2T). `apart` pushes all contacts apart, or is empty: where rounding leaves pi outside its
// cone, a little of it is added, or pi is 0 if there is none.
double DualBound(const Problem& problem, double root_energy, const Eigen::VectorXd& apart, const Eigen::VectorXd& gamma,
                 const DualPoint& point);

}  // namespace ricochet::multi

#endif  // RICOCHET_CORE_MULTI_DUAL_BOUND_H_
