// Dual: a number with its derivative, as a number type, so that a kernel written over N also gives derivatives.
//
// `rate` is the derivative of `value` by a parameter s at s = 0, for s that rises from there: Dual has the arithmetic
// of value + rate s for an s that is positive and smaller than every number (the order of R[s]/(s^2)). A value of 0 has
// therefore the sign of its rate, and a kernel takes the branch that it would take for small s > 0: the derivatives are
// one-sided where branches meet. A value counts as 0 if it is at most 2^-50 of its rate, so that a caller who lets s be
// the relative change of a double treats a branch point within 4 ulp of it as reached.
// Accuracy: that of N. Division by a value of 0 gives infinities or NaN, as N does.

// Per-target include guard.
#if defined(RICOCHET_CORE_NUMERICS_DUAL_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef RICOCHET_CORE_NUMERICS_DUAL_INL_H_
#undef RICOCHET_CORE_NUMERICS_DUAL_INL_H_
#else
#define RICOCHET_CORE_NUMERICS_DUAL_INL_H_
#endif

#include "core/numerics/codes-inl.h"
#include "core/numerics/lanes-inl.h"
#include "core/numerics/plain-inl.h"

HWY_BEFORE_NAMESPACE();
namespace ricochet::HWY_NAMESPACE {

template <typename N>
struct Dual {
  // A kernel must not replace a difference that cancels by 0, because its derivative does not vanish with it.
  static constexpr bool kCompensated = false;

  N value, rate;

  Dual() = default;
  HWY_INLINE Dual(const N& its_value, const N& its_rate) : value(its_value), rate(its_rate) {}

  HWY_INLINE static Dual Constant(double value) { return {N::Constant(value), N::Constant(0.0)}; }
};

template <typename N>
HWY_INLINE Dual<N> operator-(const Dual<N>& x) {
  return {-x.value, -x.rate};
}
template <typename N>
HWY_INLINE Dual<N> operator+(const Dual<N>& x, const Dual<N>& y) {
  return {x.value + y.value, x.rate + y.rate};
}
template <typename N>
HWY_INLINE Dual<N> operator-(const Dual<N>& x, const Dual<N>& y) {
  return {x.value - y.value, x.rate - y.rate};
}
template <typename N>
HWY_INLINE Dual<N> operator*(const Dual<N>& x, const Dual<N>& y) {
  return {x.value * y.value, x.value * y.rate + x.rate * y.value};
}
template <typename N>
HWY_INLINE Dual<N> Inverse(const Dual<N>& x) {
  const N inverse = Inverse(x.value);
  return {inverse, -(x.rate * (inverse * inverse))};
}
template <typename N>
HWY_INLINE Dual<N> operator/(const Dual<N>& x, const Dual<N>& y) {
  const N inverse = Inverse(y.value);
  const N quotient = x.value * inverse;
  return {quotient, (x.rate - quotient * y.rate) * inverse};
}

// Requires x > 0.
template <typename N>
HWY_INLINE Dual<N> Sqrt(const Dual<N>& x) {
  const N root = Sqrt(x.value);
  return {root, x.rate / (root + root)};
}

// a + x y.
template <typename N>
HWY_INLINE Dual<N> AddProduct(const Dual<N>& a, const Dual<N>& x, const Dual<N>& y) {
  return {AddProduct(a.value, x.value, y.value), a.rate + (x.value * y.rate + x.rate * y.value)};
}

// The number whose sign the dual number has.
template <typename N>
HWY_INLINE N Leading(const Dual<N>& x) {
  const N size = Select(IsNegative(x.value), -x.value, x.value);
  const N change = Select(IsNegative(x.rate), -x.rate, x.rate);
  return Select(IsPositive(size - N::Constant(0x1p-50) * change), x.value, x.rate);
}
template <typename N>
HWY_INLINE auto IsNegative(const Dual<N>& x) {
  return IsNegative(Leading(x));
}
template <typename N>
HWY_INLINE auto IsPositive(const Dual<N>& x) {
  return IsPositive(Leading(x));
}
// True if the value is negative, and does not only count as 0 beside a negative rate.
template <typename N>
HWY_INLINE auto IsNegativeItself(const Dual<N>& x) {
  const N change = Select(IsNegative(x.rate), -x.rate, x.rate);
  return IsNegative(x.value + N::Constant(0x1p-50) * change);
}
template <typename N>
HWY_INLINE auto operator<(const Dual<N>& x, const Dual<N>& y) {
  return IsNegative(x - y);
}

template <typename Mask, typename N>
HWY_INLINE Dual<N> Select(Mask condition, const Dual<N>& yes, const Dual<N>& no) {
  return {Select(condition, yes.value, no.value), Select(condition, yes.rate, no.rate)};
}

// Both numbers in double, or in a vector of doubles.
template <typename N>
HWY_INLINE auto Rounded(const Dual<N>& x) {
  using Number = Plain<decltype(Rounded(x.value))>;
  return Dual<Number>(Number(Rounded(x.value)), Number(Rounded(x.rate)));
}

template <typename V>
struct Lanes<Dual<Plain<V>>> {
  HWY_INLINE static Dual<Plain<V>> Fill(double value) { return Dual<Plain<V>>::Constant(value); }
};
template <typename V>
struct Codes<Dual<Plain<V>>> : Codes<V> {};

}  // namespace ricochet::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
