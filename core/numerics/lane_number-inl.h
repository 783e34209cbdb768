// LaneNumber: the target's widest vector of doubles as a number type, so that a template over a floating type also runs
// in SIMD lanes, with the bits of a double in each.
//
// The functions below take a floating type or a LaneNumber. A comparison of floating numbers is a bool, one of
// LaneNumbers has a truth value for each lane, and Select takes either in place of a branch. Max and Min choose as
// std::max and std::min do. LaneNumber exists where there are vectors (RICOCHET_SIMD).

// Per-target include guard.
#if defined(RICOCHET_CORE_NUMERICS_LANE_NUMBER_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef RICOCHET_CORE_NUMERICS_LANE_NUMBER_INL_H_
#undef RICOCHET_CORE_NUMERICS_LANE_NUMBER_INL_H_
#else
#define RICOCHET_CORE_NUMERICS_LANE_NUMBER_INL_H_
#endif

#include <cmath>
#include <concepts>
#include <utility>

#include "core/numerics/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace ricochet::HWY_NAMESPACE {

template <std::floating_point T>
HWY_INLINE T SquareRoot(T x) {
  return std::sqrt(x);
}
template <std::floating_point T>
HWY_INLINE T Absolute(T x) {
  return std::fabs(x);
}
template <std::floating_point T>
HWY_INLINE T CopySign(T size, T sign) {
  return std::copysign(size, sign);
}
template <std::floating_point T>
HWY_INLINE T Select(bool condition, T yes, T no) {
  return condition ? yes : no;
}
HWY_INLINE bool Differ(bool x, bool y) { return x != y; }

// The truth value of a comparison.
template <typename T>
using MaskOf = decltype(std::declval<T>() < std::declval<T>());

// The type of a constant.
template <typename T>
struct ConstantOf {
  using type = T;  // NOLINT(readability-identifier-naming): named as the traits of the standard library.
};

#if RICOCHET_SIMD
struct LaneNumber {
  Vector value;

  LaneNumber() = default;
  // Every lane has the same number.
  HWY_INLINE LaneNumber(double number) : value(Lanes<Vector>::Fill(number)) {}
  HWY_INLINE explicit LaneNumber(Vector numbers) : value(numbers) {}

  HWY_INLINE LaneNumber& operator+=(LaneNumber other) {
    value = value + other.value;
    return *this;
  }
  HWY_INLINE LaneNumber& operator-=(LaneNumber other) {
    value = value - other.value;
    return *this;
  }
  HWY_INLINE LaneNumber& operator*=(LaneNumber other) {
    value = value * other.value;
    return *this;
  }
};

template <>
struct ConstantOf<LaneNumber> {
  using type = double;
};

HWY_INLINE LaneNumber operator-(LaneNumber x) { return LaneNumber(hn::Neg(x.value)); }
HWY_INLINE LaneNumber operator+(LaneNumber x, LaneNumber y) { return LaneNumber(x.value + y.value); }
HWY_INLINE LaneNumber operator-(LaneNumber x, LaneNumber y) { return LaneNumber(x.value - y.value); }
HWY_INLINE LaneNumber operator*(LaneNumber x, LaneNumber y) { return LaneNumber(x.value * y.value); }
HWY_INLINE LaneNumber operator/(LaneNumber x, LaneNumber y) { return LaneNumber(x.value / y.value); }
HWY_INLINE VectorMask operator<(LaneNumber x, LaneNumber y) { return x.value < y.value; }
HWY_INLINE VectorMask operator<=(LaneNumber x, LaneNumber y) { return x.value <= y.value; }
HWY_INLINE VectorMask operator>(LaneNumber x, LaneNumber y) { return x.value > y.value; }
HWY_INLINE VectorMask operator>=(LaneNumber x, LaneNumber y) { return x.value >= y.value; }
HWY_INLINE VectorMask operator==(LaneNumber x, LaneNumber y) { return x.value == y.value; }

HWY_INLINE LaneNumber SquareRoot(LaneNumber x) { return LaneNumber(hn::Sqrt(x.value)); }
HWY_INLINE LaneNumber Absolute(LaneNumber x) { return LaneNumber(hn::Abs(x.value)); }
HWY_INLINE LaneNumber CopySign(LaneNumber size, LaneNumber sign) {
  return LaneNumber(hn::CopySign(size.value, sign.value));
}
HWY_INLINE LaneNumber Select(VectorMask condition, LaneNumber yes, LaneNumber no) {
  return LaneNumber(hn::IfThenElse(condition, yes.value, no.value));
}
HWY_INLINE VectorMask Differ(VectorMask x, VectorMask y) { return hn::Xor(x, y); }
#endif

template <typename T>
using Constant = typename ConstantOf<T>::type;

template <typename T>
HWY_INLINE T Max(T x, T y) {
  return Select(x < y, y, x);
}
template <typename T>
HWY_INLINE T Min(T x, T y) {
  return Select(y < x, y, x);
}

}  // namespace ricochet::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
