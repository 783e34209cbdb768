// EncloseEnds: both ends of the bounds of a planar impact, the plastic and the elastic impact, over a box of
// parameters.
//
// core/bounds/enclosure.h searches with them; docs/theory/bounds.md has the formulas. A pendulum's `a` may be of either
// sign. Every result is rounded outward. If no scene of the box is valid the ends are kNothing.

#ifndef RICOCHET_CORE_BOUNDS_PLANAR_ENDS_H_
#define RICOCHET_CORE_BOUNDS_PLANAR_ENDS_H_

#include "core/bounds/enclosure.h"

namespace ricochet {

inline constexpr Interval kNothing = {rounding::kInfinity, -rounding::kInfinity};

// Returns the members that two enclosures of one number have in common; rounding never leaves them without any.
inline Interval Both(const Interval& x, const Interval& y) {
  const Interval both = Intersect(x, y);
  return IsEmpty(both) ? x : both;
}

// Each contains the values of all scenes; kNothing where there are none.
struct PlanarEnds {
  Interval newton = kNothing, poisson = kNothing;  // The elastic impact's coefficients, 0 for scenes that lock.
  Interval energetic = kNothing;                   // 1, or 0 for scenes that lock.
  Interval tangential_plastic = kNothing, tangential_elastic = kNothing;  // f/tau at the end of the impact.
  Interval normal_plastic = kNothing, normal_elastic = kNothing;          // tau1 (N s), 0 for scenes that separate.
};

PlanarEnds EncloseEnds(const PlanarBox& box);
PlanarEnds EncloseEnds(const AffinePlanarBox& form);
PlanarEnds EncloseEnds(const PendulumBox& box);

// Gives mu_hat of a pendulum the sign of b/a; `ahead` is its range for a contact ahead of the pin, b/a > 0. Only the
// signs in `slope` count.
Interval OnItsSide(const Interval& ahead, const Interval& slope);

}  // namespace ricochet

#endif  // RICOCHET_CORE_BOUNDS_PLANAR_ENDS_H_
