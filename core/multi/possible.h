// FindPossible: bounds on linear functions of the velocity after, over all outcomes that are possible.
//
//   v+ = v- + W p,   |p_t| <= mu p_n and v_n+ >= 0 at each contact,   p . (v- + v+)/2 <= 0
//
// This set is convex and contains every outcome of orders and springs, their limits, and those of any law that takes
// energy. It does not know the coefficients of restitution. In a plane and for at most 4 contacts the exact maximum is
// found on the faces of the set (core/multi/faces.h), else the dual problem is minimised (core/multi/dual_search.h).
// Either gives a dual point, and each bound is proved by one (core/multi/dual_bound.h); it exceeds the maximum by some
// 1e-13 of its scale for faces, 1e-8 for a search, and by more where contacts may jam.
// Cost: 100 us for two contacts in a plane.

#ifndef RICOCHET_CORE_MULTI_POSSIBLE_H_
#define RICOCHET_CORE_MULTI_POSSIBLE_H_

#include <Eigen/Core>
#include <vector>

#include "absl/functional/function_ref.h"
#include "core/multi/energy.h"
#include "core/multi/problem.h"
#include "ricochet/bounds.h"

namespace ricochet::multi {

// Returns the range of gamma . v+ for each of the gammas, which have kd numbers. `metric` is that of the problem, and
// `apart` its impulse that pushes all contacts apart, or empty. Once `stopped` says true, the answer means nothing.
std::vector<Range> FindPossible(const Problem& problem, const EnergyMetric& metric, const Eigen::VectorXd& apart,
                                const std::vector<Eigen::VectorXd>& gammas, absl::FunctionRef<bool()> stopped);

}  // namespace ricochet::multi

#endif  // RICOCHET_CORE_MULTI_POSSIBLE_H_
