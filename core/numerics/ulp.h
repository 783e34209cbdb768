// Ulp distance: how many doubles lie between two doubles.
//
// The distance of neighbours is 1, subnormals, zero and infinity included: the smallest subnormal is 1 from zero, the
// largest double 1 from infinity. +0 and -0 are the same number, at distance 0, and distances run through zero.
// A NaN is at distance 0 from any NaN and at kNotComparable from everything else.

#ifndef RICOCHET_CORE_NUMERICS_ULP_H_
#define RICOCHET_CORE_NUMERICS_ULP_H_

#include <bit>
#include <cstdint>
#include <limits>

namespace ricochet {

inline constexpr uint64_t kNotComparable = std::numeric_limits<uint64_t>::max();

constexpr uint64_t UlpDistance(double x, double y) {
  const bool x_is_nan = x != x;
  const bool y_is_nan = y != y;
  if (x_is_nan || y_is_nan) return x_is_nan && y_is_nan ? 0 : kNotComparable;

  constexpr uint64_t kSign = uint64_t{1} << 63;
  const auto x_bits = std::bit_cast<uint64_t>(x);
  const auto y_bits = std::bit_cast<uint64_t>(y);
  const uint64_t x_steps = x_bits & ~kSign;  // From zero, because the bits of doubles of one sign are in order.
  const uint64_t y_steps = y_bits & ~kSign;
  if ((x_bits ^ y_bits) & kSign) return x_steps + y_steps;
  return x_steps > y_steps ? x_steps - y_steps : y_steps - x_steps;
}

}  // namespace ricochet

#endif  // RICOCHET_CORE_NUMERICS_ULP_H_
