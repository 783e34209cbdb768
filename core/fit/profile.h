// Ray: how far unknowns can go from the best fit in a direction before the data refuse it, whatever the others are.
//
// The rise at a distance t is the least objective with the unknowns of the ray held at best + t direction, less that of
// the best fit. Profile likelihood ends a 95 % interval where the rise is the quantile of chi-squared for one degree of
// freedom, and a region of two unknowns where it is that for two (Cox and Snell; Meeker and Escobar, The American
// Statistician 49 (1995) 48). A robust loss has another scale (core/fit/information.h).

#ifndef RICOCHET_CORE_FIT_PROFILE_H_
#define RICOCHET_CORE_FIT_PROFILE_H_

#include <optional>
#include <vector>

#include "core/fit/model.h"
#include "core/fit/search.h"
#include "ricochet/fit.h"

namespace ricochet::fit {

// The 95 % quantile of chi-squared for two degrees of freedom, as kFitRiseOfInterval is for one.
inline constexpr double kRiseOfRegion = 5.991464547107979;

// A place on a ray, and the least objective there.
struct RayPoint {
  double distance = 0.0;
  double rise = 0.0;  // Infinite where the scene breaks a rule.
};

struct RayEnd {
  FitEndKind kind = FitEndKind::kUnspecified;
  double distance = 0.0;
  std::vector<RayPoint> computed;  // In the order of the search.
  // A place that fits better than the best fit, if the search met one: the best fit was not the best.
  std::optional<Minimum> better;
};

// Direction moves the unknowns that are not free. A distance of 1 should be of the size of the distance to the end.
struct Direction {
  std::vector<bool> is_free;
  std::vector<double> step;
};

// Finds the end of the ray, and then so many places at equal distances before it, which show how the rise grows.
RayEnd EndOfRay(const Minimum& best, const Direction& direction, double rise, int places, Model& model);

}  // namespace ricochet::fit

#endif  // RICOCHET_CORE_FIT_PROFILE_H_
