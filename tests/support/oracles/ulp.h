// Ulp distance: how many doubles lie between two doubles.
//
// The distance of neighbours is 1, also from zero to the smallest subnormal and from the largest double to infinity.
// +0 and -0 are the same number, at distance 0, and distances are counted through zero. A NaN has distance 0 from any
// NaN and kNotComparable from everything else.

#ifndef RICOCHET_TESTS_SUPPORT_ORACLES_ULP_H_
#define RICOCHET_TESTS_SUPPORT_ORACLES_ULP_H_

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
  // The bits of the doubles of one sign are in order, so that they count the steps from zero.
  const uint64_t x_steps = x_bits & ~kSign;
  const uint64_t y_steps = y_bits & ~kSign;
  if ((x_bits ^ y_bits) & kSign) return x_steps + y_steps;
  return x_steps > y_steps ? x_steps - y_steps : y_steps - x_steps;
}

}  // namespace ricochet

#endif  // RICOCHET_TESTS_SUPPORT_ORACLES_ULP_H_
