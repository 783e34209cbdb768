// Wide: a DoubleDouble with an exponent of its own, so that nothing overflows or underflows on the way.
//
// The value is mantissa 2^exponent with |mantissa.hi| in [1/2, 1) or 0. Wide has the operations and error bounds of
// DoubleDouble at about ten times the cost. It serves inputs whose products leave the range of doubles.

#ifndef RICOCHET_CORE_NUMERICS_WIDE_H_
#define RICOCHET_CORE_NUMERICS_WIDE_H_

#include <cmath>

#include "core/numerics/double_double-inl.h"

namespace ricochet {

class Wide {
 public:
  static constexpr bool kCompensated = true;

  Wide() = default;
  static Wide Exactly(double value) { return {Mantissa::Exactly(value), 0}; }
  static Wide Constant(double value) { return Exactly(value); }

  friend Wide operator-(const Wide& x) { return {-x.mantissa_, x.exponent_}; }
  friend Wide operator*(const Wide& x, const Wide& y) { return {x.mantissa_ * y.mantissa_, x.exponent_ + y.exponent_}; }
  friend Wide Inverse(const Wide& x) { return {Inverse(x.mantissa_), -x.exponent_}; }
  friend Wide operator/(const Wide& x, const Wide& y) { return x * Inverse(y); }
  friend Wide operator+(const Wide& x, const Wide& y) {
    if (x.mantissa_.hi == 0.0) return y;
    if (y.mantissa_.hi == 0.0) return x;
    const bool x_leads = x.exponent_ >= y.exponent_;
    const Wide& big = x_leads ? x : y;
    const Wide& small = x_leads ? y : x;
    const int shift = big.exponent_ - small.exponent_;
    // An addend below 2^-400 of the sum cannot change a bit of the result or its sign.
    if (shift > 400) return big;
    return {big.mantissa_ + Scaled(small.mantissa_, -shift), big.exponent_};
  }
  friend Wide operator-(const Wide& x, const Wide& y) { return x + -y; }
  friend Wide AddProduct(const Wide& a, const Wide& x, const Wide& y) { return a + x * y; }
  friend Wide SubtractProduct(const Wide& a, const Wide& x, const Wide& y) { return a - x * y; }
  friend void InvertBoth(const Wide& x, const Wide& y, Wide& inverse_x, Wide& inverse_y) {
    inverse_x = Inverse(x);
    inverse_y = Inverse(y);
  }

  // Requires x > 0.
  friend Wide Sqrt(const Wide& x) {
    const int odd = x.exponent_ & 1;
    return {Sqrt(Scaled(x.mantissa_, odd)), (x.exponent_ - odd) / 2};
  }

  friend bool IsNegative(const Wide& x) { return x.mantissa_.hi < 0.0; }
  friend bool IsPositive(const Wide& x) { return x.mantissa_.hi > 0.0; }
  friend Wide Select(bool condition, const Wide& yes, const Wide& no) { return condition ? yes : no; }

  // The double nearest to the value; infinite above the largest double.
  friend double Rounded(const Wide& x) { return std::ldexp(x.mantissa_.hi, x.exponent_); }
  friend double RoundedProduct(const Wide& x, const Wide& y) { return Rounded(x * y); }

 private:
  using Mantissa = HWY_NAMESPACE::DoubleDouble<double>;

  Wide(Mantissa mantissa, int exponent) : mantissa_(mantissa), exponent_(exponent) {
    int shift = 0;
    (void)std::frexp(mantissa_.hi, &shift);
    mantissa_ = Scaled(mantissa_, -shift);
    exponent_ = mantissa_.hi == 0.0 ? 0 : exponent_ + shift;
  }

  static Mantissa Scaled(Mantissa x, int exponent) { return {std::ldexp(x.hi, exponent), std::ldexp(x.lo, exponent)}; }

  Mantissa mantissa_ = Mantissa::Constant(0.0);
  int exponent_ = 0;
};

}  // namespace ricochet

#endif  // RICOCHET_CORE_NUMERICS_WIDE_H_
