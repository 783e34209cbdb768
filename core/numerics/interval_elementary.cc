#include "core/numerics/interval_elementary.h"

#include <algorithm>
#include <cmath>

#include "core/numerics/elementary.h"

namespace ricochet {
namespace {

constexpr Interval kHalfPi = {0x1.921fb54442d18p+0, 0x1.921fb54442d19p+0};

// Returns an interval that contains the exact value of a function, given the value computed to within kElementaryUlps.
Interval Around(double value) {
  constexpr double kInfinity = rounding::kInfinity;
  return {std::nextafter(std::nextafter(value, -kInfinity), -kInfinity),
          std::nextafter(std::nextafter(value, kInfinity), kInfinity)};
}

// Tells whether an integer of this remainder modulo 4 may lie in `quarters`.
bool HoldsQuarter(const Interval& quarters, int remainder) {
  const double first = std::ceil(quarters.lower);
  for (double n = first; n <= std::min(quarters.upper, first + 3.0); n += 1.0) {
    if (n - 4.0 * std::floor(n / 4.0) == remainder) return true;
  }
  return false;
}

// Encloses a sine or cosine: it has the period of 4 quarter turns, is 1 at quarter turn `top` and -1 two further on.
Interval Wave(const Interval& radians, double (*function)(double), int top) {
  const Interval unit(-1.0, 1.0);
  const Interval low = Around(function(radians.lower));
  if (IsPoint(radians)) return Intersect(low, unit);
  const Interval quarters = radians / kHalfPi;
  if (!(Abs(quarters).upper <= kMostQuarters)) return unit;
  Interval range = Hull(low, Around(function(radians.upper)));
  if (HoldsQuarter(quarters, top)) range.upper = 1.0;
  if (HoldsQuarter(quarters, (top + 2) % 4)) range.lower = -1.0;
  return Intersect(range, unit);
}

}  // namespace

Interval Sin(const Interval& radians) {
  if (radians == Interval(0.0)) return 0.0;
  return Wave(radians, Sin, 1);
}

Interval Cos(const Interval& radians) {
  if (radians == Interval(0.0)) return 1.0;
  return Wave(radians, Cos, 0);
}

Interval Pow(const Interval& base, double exponent) {
  if (exponent == 0.0) return 1.0;
  if (exponent == 1.0) return base;
  const auto at = [exponent](double x) {
    if (x == 0.0) return Interval(exponent > 0.0 ? 0.0 : rounding::kInfinity);
    return x == 1.0 ? Interval(1.0) : AtLeast(Around(Pow(x, exponent)), 0.0);
  };
  if (exponent < 0.0) return {at(base.upper).lower, at(base.lower).upper};
  return {at(base.lower).lower, at(base.upper).upper};
}

}  // namespace ricochet
