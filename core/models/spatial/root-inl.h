// The root of an increasing function by Newton's method, kept within a bracket.

// Per-target include guard.
#if defined(RICOCHET_CORE_MODELS_SPATIAL_ROOT_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef RICOCHET_CORE_MODELS_SPATIAL_ROOT_INL_H_
#undef RICOCHET_CORE_MODELS_SPATIAL_ROOT_INL_H_
#else
#define RICOCHET_CORE_MODELS_SPATIAL_ROOT_INL_H_
#endif

#include <cmath>

#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace ricochet::spatial::HWY_NAMESPACE {

// The value of a function and its slope.
template <typename T>
struct Rates {
  T value, slope;
};

// The root of an increasing function with f(0) < 0 <= f(end), from a first guess. A step that would leave the bracket
// is replaced by a bisection, and the first step of at most `last` times the root is the last one.
template <typename T, typename Function>
T FindRoot(const Function& function, T guess, T end, T last) {
  T low{0};
  T high = end;
  T x = guess > T{0} && guess < end ? guess : end;
  constexpr int kEnough = 200;
  for (int i = 0; i < kEnough && high > low; ++i) {
    const Rates<T> at = function(x);
    (at.value < T{0} ? low : high) = x;
    T next = x - at.value / at.slope;
    if (!(next > low && next < high)) {
      if (at.value == T{0} || std::fabs(next - x) <= last * x) return x;
      next = T{0.5} * (low + high);
    }
    if (std::fabs(next - x) <= last * next) return next;
    x = next;
  }
  return x;
}

}  // namespace ricochet::spatial::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
