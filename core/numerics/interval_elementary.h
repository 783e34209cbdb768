// Sin, Cos and Pow of intervals: they contain the value at every member.
//
// At an end the function is that of core/numerics/elementary.h, two doubles outward: one for its kElementaryUlps = 1,
// one for an exact value in the binade above. In between Sin and Cos reach 1 or -1 where x/(pi/2), enclosed, holds an
// integer that says so; above kMostQuarters an interval that is not a point gives [-1, 1].

#ifndef RICOCHET_CORE_NUMERICS_INTERVAL_ELEMENTARY_H_
#define RICOCHET_CORE_NUMERICS_INTERVAL_ELEMENTARY_H_

#include "core/numerics/interval.h"

namespace ricochet {

inline constexpr double kMostQuarters = 0x1p40;

Interval Sin(const Interval& radians);
Interval Cos(const Interval& radians);

// base >= 0, where the exponent is negative 0 gives infinity. Exact for the exponents 0 and 1.
Interval Pow(const Interval& base, double exponent);

}  // namespace ricochet

#endif  // RICOCHET_CORE_NUMERICS_INTERVAL_ELEMENTARY_H_
