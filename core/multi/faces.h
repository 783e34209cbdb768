// Faces: the exact maxima of linear functions over the outcomes that are possible, for at most 4 contacts of a plane.
//
// In the metric of energy v = G y, the outcomes are the points of (y- + cone of the 2k rays n +- mu t), of the half
// spaces v_n >= 0 and of the ball |y| <= |y-|. A maximum lies in the interior of one face: the flat of some independent
// rays and some v_n = 0, cut by the ball. On such a flat it is c + sqrt(|y-|^2 - |c|^2) w/|w|, where c is the point
// nearest to 0 and w the projection of the function. All faces are tried.

#ifndef RICOCHET_CORE_MULTI_FACES_H_
#define RICOCHET_CORE_MULTI_FACES_H_

#include <vector>

#include "core/multi/dual_bound.h"
#include "core/multi/energy.h"

namespace ricochet::multi {

inline constexpr int kMostContactsOfFaces = 4;

// The faces on which a function has its maximum. Where several have the same, rounding decides which one proves it.
struct Maximum {
  double value = 0.0;
  std::vector<DualPoint> proofs;  // Empty if no face was found.
};

// The maxima of gamma . v+ and of -gamma . v+, for each direction in turn.
std::vector<Maximum> MaximaOnFaces(const Problem& problem, const EnergyMetric& metric,
                                   const std::vector<Eigen::VectorXd>& directions);

}  // namespace ricochet::multi

#endif  // RICOCHET_CORE_MULTI_FACES_H_
