// Differences: the step and the mean of difference quotients, which are used where exact derivatives do not exist.

#ifndef RICOCHET_CORE_FIT_DIFFERENCES_H_
#define RICOCHET_CORE_FIT_DIFFERENCES_H_

#include <cmath>

namespace ricochet::fit {

// The cube root of the rounding of a double: the step, over the size of a number, for which central differences are
// most exact.
inline constexpr double kDifferenceStep = 6e-6;

// Returns the mean slope of both sides. A side that does not exist is NaN and does not count; without both it is 0.
inline double MeanOfSides(double below, double above) {
  if (std::isnan(below)) return std::isnan(above) ? 0.0 : above;
  return std::isnan(above) ? below : 0.5 * (below + above);
}

}  // namespace ricochet::fit

#endif  // RICOCHET_CORE_FIT_DIFFERENCES_H_
