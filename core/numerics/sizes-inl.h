// Sizes: the range of the magnitudes of numbers, lane by lane, to tell whether a product of them can leave the range of
// doubles.

// Per-target include guard.
#if defined(RICOCHET_CORE_NUMERICS_SIZES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef RICOCHET_CORE_NUMERICS_SIZES_INL_H_
#undef RICOCHET_CORE_NUMERICS_SIZES_INL_H_
#else
#define RICOCHET_CORE_NUMERICS_SIZES_INL_H_
#endif

#include "core/numerics/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace ricochet::HWY_NAMESPACE {

// The least and the largest magnitude in each lane of all numbers taken in, zeros left out. Both start at 1.
template <typename V>
struct Sizes {
  V least;
  V most;

  HWY_INLINE Sizes() : least(Lanes<V>::Fill(1.0)), most(Lanes<V>::Fill(1.0)) {}

  HWY_INLINE void Include(V x) {
    const V size = Absolute(x);
    most = Larger(most, size);
    least = Smaller(least, Select(Lanes<V>::Fill(0.0) < size, size, Lanes<V>::Fill(1.0)));
  }

  // True where all are at least `lower` and at most `upper`.
  HWY_INLINE auto AreWithin(double lower, double upper) const {
    return Both(Lanes<V>::Fill(lower) <= least, most <= Lanes<V>::Fill(upper));
  }
  // True where all are at least 1/limit and at most `limit`.
  HWY_INLINE auto AreWithin(double limit) const { return AreWithin(1.0 / limit, limit); }
};

}  // namespace ricochet::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
