// This file is compiled once for each SIMD target (foreach_target.h includes it again). The target is chosen at run time.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/numerics/range.cc"
#include "core/numerics/range.h"

#include <algorithm>
#include <limits>

// Highway prescribes the order of these includes.
// clang-format off
#include "hwy/foreach_target.h"
#include "core/numerics/lanes-inl.h"
// clang-format on

HWY_BEFORE_NAMESPACE();
namespace ricochet::HWY_NAMESPACE {

// The range of the numbers that a V has at each place from `first` on, the last of which may overlap the one before it.
template <typename V>
Range RangeIn(const double* numbers, size_t count) {
  const size_t last = count - Lanes<V>::Count();
  V least = Lanes<V>::Load(numbers);
  V most = least;
  auto is_number = least == least;
  for (size_t i = 0; i < last;) {
    i = std::min(i + Lanes<V>::Count(), last);
    const V x = Lanes<V>::Load(numbers + i);
    least = Smaller(least, x);
    most = Larger(most, x);
    is_number = Both(is_number, x == x);
  }
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  if (!InAllLanes(is_number)) return {kNaN, kNaN};
  double leasts[64];
  double mosts[64];
  Lanes<V>::Store(least, leasts);
  Lanes<V>::Store(most, mosts);
  return {*std::min_element(leasts, leasts + Lanes<V>::Count()), *std::max_element(mosts, mosts + Lanes<V>::Count())};
}

Range RangeOfAll(const double* numbers, size_t count) {
  if (count < Lanes<Vector>::Count()) return RangeIn<double>(numbers, count);
  return RangeIn<Vector>(numbers, count);
}

}  // namespace ricochet::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace ricochet {

HWY_EXPORT(RangeOfAll);

Range RangeOf(const double* numbers, size_t count) { return HWY_DYNAMIC_DISPATCH(RangeOfAll)(numbers, count); }

}  // namespace ricochet

#endif  // HWY_ONCE
