// DoubleDouble: the unevaluated sum of two doubles, 106 bits, by error-free transformations.
//
// hi = RN(hi + lo), so hi is the value rounded to a double. Sums and products of doubles are exact or wrong by at most
// 3 u^2 (+), 5 u^2 (*), 10 u^2 (/), 4 u^2 (sqrt) of the result, u = 2^-53: Joldes, Muller, Popescu (2017), Tight and
// rigorous error bounds for basic building blocks of double-word arithmetic, algorithms 6, 12 and 18; the sign of a sum
// is therefore always right. No operation may overflow or underflow: callers keep to moderate exponents or use
// core/numerics/wide.h. Every function is inlined, so that it takes on its caller's target (with or without a
// hardware fma); the bits are the same on both, because std::fma is exact on both.

#ifndef RICOCHET_CORE_NUMERICS_DOUBLE_DOUBLE_H_
#define RICOCHET_CORE_NUMERICS_DOUBLE_DOUBLE_H_

#include <cmath>

#define RICOCHET_INLINE [[gnu::always_inline]] inline

namespace ricochet {

struct DoubleDouble {
  double hi = 0.0;
  double lo = 0.0;

  DoubleDouble() = default;
  RICOCHET_INLINE explicit DoubleDouble(double value) : hi(value) {}
  RICOCHET_INLINE DoubleDouble(double high, double low) : hi(high), lo(low) {}
};

// a + b exactly.
RICOCHET_INLINE DoubleDouble TwoSum(double a, double b) {
  const double sum = a + b;
  const double b_part = sum - a;
  return {sum, (a - (sum - b_part)) + (b - b_part)};
}

// a + b exactly, for |a| >= |b| or a = 0.
RICOCHET_INLINE DoubleDouble QuickTwoSum(double a, double b) {
  const double sum = a + b;
  return {sum, b - (sum - a)};
}

// a b exactly.
RICOCHET_INLINE DoubleDouble TwoProduct(double a, double b) {
  const double product = a * b;
  return {product, std::fma(a, b, -product)};
}

RICOCHET_INLINE DoubleDouble operator-(DoubleDouble x) { return {-x.hi, -x.lo}; }

RICOCHET_INLINE DoubleDouble operator+(DoubleDouble x, DoubleDouble y) {
  const DoubleDouble high = TwoSum(x.hi, y.hi);
  const DoubleDouble low = TwoSum(x.lo, y.lo);
  const DoubleDouble sum = QuickTwoSum(high.hi, high.lo + low.hi);
  return QuickTwoSum(sum.hi, sum.lo + low.lo);
}

RICOCHET_INLINE DoubleDouble operator-(DoubleDouble x, DoubleDouble y) { return x + -y; }

RICOCHET_INLINE DoubleDouble operator*(DoubleDouble x, DoubleDouble y) {
  const DoubleDouble product = TwoProduct(x.hi, y.hi);
  const double cross = std::fma(x.lo, y.hi, std::fma(x.hi, y.lo, x.lo * y.lo));
  return QuickTwoSum(product.hi, product.lo + cross);
}

// 1/x, one Newton step in double-double on the double's.
RICOCHET_INLINE DoubleDouble Inverse(DoubleDouble x) {
  const double inverse = 1.0 / x.hi;
  const DoubleDouble rest = QuickTwoSum(std::fma(-x.hi, inverse, 1.0), -(x.lo * inverse));
  return DoubleDouble(inverse) + DoubleDouble(inverse) * rest;
}

RICOCHET_INLINE DoubleDouble operator/(DoubleDouble x, DoubleDouble y) { return x * Inverse(y); }

// x >= 0.
RICOCHET_INLINE DoubleDouble Sqrt(DoubleDouble x) {
  if (x.hi == 0.0) return {};
  const double root = std::sqrt(x.hi);
  const double rest = std::fma(-root, root, x.hi) + x.lo;
  return QuickTwoSum(root, rest / (root + root));
}

// -1, 0 or 1.
RICOCHET_INLINE int Sign(DoubleDouble x) { return (x.hi > 0.0) - (x.hi < 0.0); }

RICOCHET_INLINE double ToDouble(DoubleDouble x) { return x.hi; }

// ToDouble(x y) up to 2^-50 ulp, for a third of the work.
RICOCHET_INLINE double RoundedProduct(DoubleDouble x, DoubleDouble y) {
  return std::fma(x.hi, y.hi, std::fma(x.hi, y.lo, x.lo * y.hi));
}

}  // namespace ricochet

#endif  // RICOCHET_CORE_NUMERICS_DOUBLE_DOUBLE_H_
