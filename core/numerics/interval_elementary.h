// Sin, Cos and Pow of intervals: they contain the value at every member.
//
// At each end they take the function of core/numerics/elementary.h and move two doubles outward: one for its
// kElementaryUlps = 1, and one in case the exact value lies in the binade above. Between the ends Sin and Cos reach 1
// or -1 if an enclosure of x/(pi/2) holds an integer at which they do. Above kMostQuarters any interval other than a
// point gives [-1, 1].

#ifndef RICOCHET_CORE_NUMERICS_INTERVAL_ELEMENTARY_H_
#define RICOCHET_CORE_NUMERICS_INTERVAL_ELEMENTARY_H_

#include "core/numerics/interval.h"

namespace ricochet {

inline constexpr double kMostQuarters = 0x1p40;

Interval Sin(const Interval& radians);
Interval Cos(const Interval& radians);

// Requires base >= 0. A base of 0 with a negative exponent gives infinity. The exponents 0 and 1 give exact results.
Interval Pow(const Interval& base, double exponent);

}  // namespace ricochet

#endif  // RICOCHET_CORE_NUMERICS_INTERVAL_ELEMENTARY_H_
