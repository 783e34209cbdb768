// Plain: a double or a vector of doubles (core/numerics/lanes-inl.h) as a number type, so that a kernel written over
// DoubleDouble also runs at the cost of plain arithmetic.
//
// Each operation is rounded once, with a relative error of at most u = 2^-53 unless the result underflows. AddProduct
// and SubtractProduct round once as a whole, so that the sign of a + x y is exact. A kernel has to prove what its
// results are worth; docs/theory/rounding.md does.

// Per-target include guard.
#if defined(RICOCHET_CORE_NUMERICS_PLAIN_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef RICOCHET_CORE_NUMERICS_PLAIN_INL_H_
#undef RICOCHET_CORE_NUMERICS_PLAIN_INL_H_
#else
#define RICOCHET_CORE_NUMERICS_PLAIN_INL_H_
#endif

#include "core/numerics/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace ricochet::HWY_NAMESPACE {

template <typename V>
struct Plain {
  static constexpr bool kCompensated = false;

  V value;

  // The value is unset, because initialising a vector would cost a call.
  Plain() = default;
  HWY_INLINE explicit Plain(V exact) : value(exact) {}

  // Every lane has exactly `value`.
  HWY_INLINE static Plain Constant(double value) { return Plain(Lanes<V>::Fill(value)); }
  HWY_INLINE static Plain Exactly(V value) { return Plain(value); }
};

template <typename V>
HWY_INLINE Plain<V> operator-(Plain<V> x) {
  return Plain<V>(Lanes<V>::Fill(0.0) - x.value);
}
template <typename V>
HWY_INLINE Plain<V> operator+(Plain<V> x, Plain<V> y) {
  return Plain<V>(x.value + y.value);
}
template <typename V>
HWY_INLINE Plain<V> operator-(Plain<V> x, Plain<V> y) {
  return Plain<V>(x.value - y.value);
}
template <typename V>
HWY_INLINE Plain<V> operator*(Plain<V> x, Plain<V> y) {
  return Plain<V>(x.value * y.value);
}
template <typename V>
HWY_INLINE Plain<V> operator/(Plain<V> x, Plain<V> y) {
  return Plain<V>(x.value / y.value);
}
template <typename V>
HWY_INLINE Plain<V> Inverse(Plain<V> x) {
  return Plain<V>(Lanes<V>::Fill(1.0) / x.value);
}

// Computes both inverses with one division, each to within 3 u. Neither number may be 0.
template <typename V>
HWY_INLINE void InvertBoth(Plain<V> x, Plain<V> y, Plain<V>& inverse_x, Plain<V>& inverse_y) {
  const Plain<V> inverse = Inverse(x * y);
  inverse_x = y * inverse;
  inverse_y = x * inverse;
}

// Requires x > 0.
template <typename V>
HWY_INLINE Plain<V> Sqrt(Plain<V> x) {
  return Plain<V>(SquareRoot(x.value));
}

// These two return a + x y and a - x y with one rounding.
template <typename V>
HWY_INLINE Plain<V> AddProduct(Plain<V> a, Plain<V> x, Plain<V> y) {
  return Plain<V>(Fma(x.value, y.value, a.value));
}
template <typename V>
HWY_INLINE Plain<V> SubtractProduct(Plain<V> a, Plain<V> x, Plain<V> y) {
  return Plain<V>(NegativeFma(x.value, y.value, a.value));
}

// Comparisons give one truth value for each lane.
template <typename V>
HWY_INLINE auto IsNegative(Plain<V> x) {
  return x.value < Lanes<V>::Fill(0.0);
}
template <typename V>
HWY_INLINE auto IsPositive(Plain<V> x) {
  return Lanes<V>::Fill(0.0) < x.value;
}

template <typename Mask, typename V>
HWY_INLINE Plain<V> Select(Mask condition, Plain<V> yes, Plain<V> no) {
  return Plain<V>(Select(condition, yes.value, no.value));
}

template <typename V>
HWY_INLINE V Rounded(Plain<V> x) {
  return x.value;
}
template <typename V>
HWY_INLINE V RoundedProduct(Plain<V> x, Plain<V> y) {
  return x.value * y.value;
}

}  // namespace ricochet::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
