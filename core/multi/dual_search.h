// MinimiseDual: a dual point whose bound (core/multi/dual_bound.h) is near the least, for any number of contacts, in a
// plane or in space.
//
// The dual problem is convex: a norm plus a linear function of nu and pi, with nu >= 0 and pi in a product of second
// order cones. Newton's method follows the path of a logarithmic barrier. Every point of the path proves a bound; the
// last is within some 1e-9 of the scale of the least.

#ifndef RICOCHET_CORE_MULTI_DUAL_SEARCH_H_
#define RICOCHET_CORE_MULTI_DUAL_SEARCH_H_

#include "absl/functional/function_ref.h"
#include "core/multi/dual_bound.h"
#include "core/multi/energy.h"

namespace ricochet::multi {

// `apart` pushes all contacts apart, or is empty: pi is then 0. Once `stopped` says true, the point is the one reached.
DualPoint MinimiseDual(const Problem& problem, const EnergyMetric& metric, const Eigen::VectorXd& apart,
                       const Eigen::VectorXd& gamma, absl::FunctionRef<bool()> stopped);

}  // namespace ricochet::multi

#endif  // RICOCHET_CORE_MULTI_DUAL_SEARCH_H_
