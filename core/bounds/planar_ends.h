// The two ends of a planar impact's bounds, the dead impact and the elastic one, over a box of parameters; private to
// core/laws. core/bounds/enclosure.h has the formulas. A pendulum's `a` may be of either sign.

#ifndef RICOCHET_CORE_BOUNDS_PLANAR_ENDS_H_
#define RICOCHET_CORE_BOUNDS_PLANAR_ENDS_H_

#include "core/bounds/enclosure.h"

namespace ricochet {

inline constexpr Interval kNothing = {rounding::kInfinity, -rounding::kInfinity};

// Each contains the values of all scenes; kNothing where there are none.
struct PlanarEnds {
  Interval newton = kNothing, poisson = kNothing;  // Elastic; 0 where locked.
  Interval energetic = kNothing;                   // 1; 0 where locked.
  Interval tangential_dead = kNothing, tangential_elastic = kNothing;
  Interval normal_dead = kNothing, normal_elastic = kNothing;  // tau1; 0 where separating.
};

PlanarEnds EncloseEnds(const PlanarBox& box);
PlanarEnds EncloseEnds(const PlanarForm& form);
PlanarEnds EncloseEnds(const PendulumBox& box);

}  // namespace ricochet

#endif  // RICOCHET_CORE_BOUNDS_PLANAR_ENDS_H_
