// DoubleDouble: the unevaluated sum of two doubles, 106 bits, by error-free transformations; V is a double or a vector
// of them (core/numerics/lanes-inl.h).
//
// hi = RN(hi + lo), so hi is the value rounded to a double. Sums and products of doubles are exact or wrong by at most
// 3 u^2 (+), 5 u^2 (*), 10 u^2 (1/x), 4 u^2 (sqrt) of the result, u = 2^-53: Joldes, Muller, Popescu (2017), Tight and
// rigorous error bounds for basic building blocks of double-word arithmetic, algorithms 6, 12 and 18; the sign of a sum
// is therefore always right. No operation may overflow or underflow: callers keep to moderate exponents or use
// core/numerics/wide.h.

// Per-target include guard.
#if defined(RICOCHET_CORE_NUMERICS_DOUBLE_DOUBLE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef RICOCHET_CORE_NUMERICS_DOUBLE_DOUBLE_INL_H_
#undef RICOCHET_CORE_NUMERICS_DOUBLE_DOUBLE_INL_H_
#else
#define RICOCHET_CORE_NUMERICS_DOUBLE_DOUBLE_INL_H_
#endif

#include "core/numerics/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace ricochet::HWY_NAMESPACE {

template <typename V>
struct DoubleDouble {
  static constexpr bool kCompensated = true;

  V hi;
  V lo;

  // The value is unset, because initialising a vector would cost a call.
  DoubleDouble() = default;
  HWY_INLINE DoubleDouble(V high, V low) : hi(high), lo(low) {}

  // Every lane has exactly `value`.
  HWY_INLINE static DoubleDouble Constant(double value) { return Exactly(Lanes<V>::Fill(value)); }
  HWY_INLINE static DoubleDouble Exactly(V value) { return {value, Lanes<V>::Fill(0.0)}; }
};

// Returns a + b exactly.
template <typename V>
HWY_INLINE DoubleDouble<V> TwoSum(V a, V b) {
  const V sum = a + b;
  const V b_part = sum - a;
  return {sum, (a - (sum - b_part)) + (b - b_part)};
}

// Returns a + b exactly. Requires |a| >= |b| or a = 0.
template <typename V>
HWY_INLINE DoubleDouble<V> QuickTwoSum(V a, V b) {
  const V sum = a + b;
  return {sum, b - (sum - a)};
}

// Returns a b exactly.
template <typename V>
HWY_INLINE DoubleDouble<V> TwoProduct(V a, V b) {
  const V product = a * b;
  return {product, FmaSubtract(a, b, product)};
}

template <typename V>
HWY_INLINE DoubleDouble<V> operator-(DoubleDouble<V> x) {
  const V zero = Lanes<V>::Fill(0.0);
  return {zero - x.hi, zero - x.lo};
}

template <typename V>
HWY_INLINE DoubleDouble<V> operator+(DoubleDouble<V> x, DoubleDouble<V> y) {
  const DoubleDouble<V> high = TwoSum(x.hi, y.hi);
  const DoubleDouble<V> low = TwoSum(x.lo, y.lo);
  const DoubleDouble<V> sum = QuickTwoSum(high.hi, high.lo + low.hi);
  return QuickTwoSum(sum.hi, sum.lo + low.lo);
}

template <typename V>
HWY_INLINE DoubleDouble<V> operator-(DoubleDouble<V> x, DoubleDouble<V> y) {
  return x + -y;
}

template <typename V>
HWY_INLINE DoubleDouble<V> operator*(DoubleDouble<V> x, DoubleDouble<V> y) {
  const DoubleDouble<V> product = TwoProduct(x.hi, y.hi);
  const V cross = Fma(x.lo, y.hi, Fma(x.hi, y.lo, x.lo * y.lo));
  return QuickTwoSum(product.hi, product.lo + cross);
}

// 1/x by one Newton step in double-double from the reciprocal in double.
template <typename V>
HWY_INLINE DoubleDouble<V> Inverse(DoubleDouble<V> x) {
  using N = DoubleDouble<V>;
  const V one = Lanes<V>::Fill(1.0);
  const V inverse = one / x.hi;
  const V high_rest = NegativeFma(x.hi, inverse, one);
  const N rest = QuickTwoSum(high_rest, NegativeFma(x.lo, inverse, Lanes<V>::Fill(0.0)));
  return N::Exactly(inverse) + N::Exactly(inverse) * rest;
}

template <typename V>
HWY_INLINE DoubleDouble<V> operator/(DoubleDouble<V> x, DoubleDouble<V> y) {
  return x * Inverse(y);
}

template <typename V>
HWY_INLINE void InvertBoth(DoubleDouble<V> x, DoubleDouble<V> y, DoubleDouble<V>& inverse_x,
                           DoubleDouble<V>& inverse_y) {
  inverse_x = Inverse(x);
  inverse_y = Inverse(y);
}

// These two return a + x y and a - x y.
template <typename V>
HWY_INLINE DoubleDouble<V> AddProduct(DoubleDouble<V> a, DoubleDouble<V> x, DoubleDouble<V> y) {
  return a + x * y;
}
template <typename V>
HWY_INLINE DoubleDouble<V> SubtractProduct(DoubleDouble<V> a, DoubleDouble<V> x, DoubleDouble<V> y) {
  return a - x * y;
}

// Requires x > 0.
template <typename V>
HWY_INLINE DoubleDouble<V> Sqrt(DoubleDouble<V> x) {
  const V root = SquareRoot(x.hi);
  const V rest = NegativeFma(root, root, x.hi) + x.lo;
  return QuickTwoSum(root, rest / (root + root));
}

// Comparisons give one truth value for each lane.
template <typename V>
HWY_INLINE auto IsNegative(DoubleDouble<V> x) {
  return x.hi < Lanes<V>::Fill(0.0);
}
template <typename V>
HWY_INLINE auto IsPositive(DoubleDouble<V> x) {
  return Lanes<V>::Fill(0.0) < x.hi;
}

template <typename Mask, typename V>
HWY_INLINE DoubleDouble<V> Select(Mask condition, DoubleDouble<V> yes, DoubleDouble<V> no) {
  return {Select(condition, yes.hi, no.hi), Select(condition, yes.lo, no.lo)};
}

// The V nearest to the value.
template <typename V>
HWY_INLINE V Rounded(DoubleDouble<V> x) {
  return x.hi;
}

// Computes Rounded(x y) to within 2^-50 ulp, at a third of the cost.
template <typename V>
HWY_INLINE V RoundedProduct(DoubleDouble<V> x, DoubleDouble<V> y) {
  return Fma(x.hi, y.hi, Fma(x.hi, y.lo, x.lo * y.hi));
}

}  // namespace ricochet::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
