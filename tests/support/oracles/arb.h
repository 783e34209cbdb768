// Ball: a real number enclosed by Arb, as a C++ value.
//
// Every operation encloses the exact result; exponents have no limit, so that nothing overflows or underflows. A ball
// carries its precision, and an operation uses the larger precision of its operands: constants written as doubles take
// on that of the other side. With kExact, sums, differences and products are exact (/ and Sqrt must not be used).

#ifndef RICOCHET_TESTS_SUPPORT_ORACLES_ARB_H_
#define RICOCHET_TESTS_SUPPORT_ORACLES_ARB_H_

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <string>

#include "core/certified/flint.h"

namespace ricochet {

class Ball {
 public:
  static constexpr slong kExact = ARF_PREC_EXACT;

  Ball() { arb_init(value_); }
  // The conversion is implicit, so that formulas read like formulas. `exact` must be finite.
  Ball(double exact, slong bits = 53) : bits_(bits) {
    assert(std::isfinite(exact));
    arb_init(value_);
    arb_set_d(value_, exact);
  }
  Ball(const Ball& other) : bits_(other.bits_) {
    arb_init(value_);
    arb_set(value_, other.value_);
  }
  Ball(Ball&& other) noexcept : bits_(other.bits_) {
    arb_init(value_);
    arb_swap(value_, other.value_);
  }
  Ball& operator=(Ball other) noexcept {
    arb_swap(value_, other.value_);
    bits_ = other.bits_;
    return *this;
  }
  ~Ball() { arb_clear(value_); }

  // The ball around a decimal, as narrow as `bits` allow.
  static Ball Parse(const std::string& decimal, slong bits) {
    Ball ball(0.0, bits);
    [[maybe_unused]] const int failed = arb_set_str(ball.value_, decimal.c_str(), bits);
    assert(!failed);
    return ball;
  }
  // 2^exponent.
  static Ball PowerOfTwo(slong exponent) {
    Ball ball(1.0);
    arb_mul_2exp_si(ball.value_, ball.value_, exponent);
    return ball;
  }

  friend Ball operator+(const Ball& x, const Ball& y) { return Apply(arb_add, x, y); }
  friend Ball operator-(const Ball& x, const Ball& y) { return Apply(arb_sub, x, y); }
  friend Ball operator*(const Ball& x, const Ball& y) { return Apply(arb_mul, x, y); }
  friend Ball operator/(const Ball& x, const Ball& y) { return Apply(arb_div, x, y); }
  friend Ball operator-(Ball x) {
    arb_neg(x.value_, x.value_);
    return x;
  }
  friend Ball Abs(Ball x) {
    arb_abs(x.value_, x.value_);
    return x;
  }
  // The ball that has the centre alone.
  friend Ball Middle(Ball x) {
    mag_zero(arb_radref(x.value_));
    return x;
  }
  // A ball that contains both.
  friend Ball Union(const Ball& x, const Ball& y) { return Apply(arb_union, x, y); }
  friend Ball Sqrt(const Ball& x) {
    Ball root(0.0, x.bits_);
    arb_sqrt(root.value_, x.value_, x.bits_);
    return root;
  }
  friend Ball Sin(const Ball& x) { return Apply(arb_sin, x); }
  friend Ball Cos(const Ball& x) { return Apply(arb_cos, x); }
  friend Ball Exp(const Ball& x) { return Apply(arb_exp, x); }
  friend Ball Log(const Ball& x) { return Apply(arb_log, x); }
  friend Ball Pow(const Ball& x, const Ball& y) { return Apply(arb_pow, x, y); }

  // A comparison is true only if it holds for every point of one ball and every point of the other.
  friend bool operator<(const Ball& x, const Ball& y) { return arb_lt(x.value_, y.value_); }
  friend bool operator<=(const Ball& x, const Ball& y) { return arb_le(x.value_, y.value_); }
  friend bool operator>(const Ball& x, const Ball& y) { return arb_gt(x.value_, y.value_); }
  friend bool operator>=(const Ball& x, const Ball& y) { return arb_ge(x.value_, y.value_); }

  bool IsExact() const { return arb_is_exact(value_); }
  bool ContainsZero() const { return arb_contains_zero(value_); }
  slong RelativeAccuracyBits() const { return arb_rel_accuracy_bits(value_); }
  // |x| < 2^this for the ball's centre.
  slong Exponent() const { return arf_abs_bound_lt_2exp_si(arb_midref(value_)); }
  Ball Radius() const {
    Ball radius;
    arf_set_mag(arb_midref(radius.value_), arb_radref(value_));
    return radius;
  }

  // The double nearest to the centre; infinite above the largest one.
  double Nearest() const { return arf_get_d(arb_midref(value_), ARF_RND_NEAR); }
  // A double that no point of the ball exceeds.
  double UpperBound() const {
    arf_t bound;
    arf_init(bound);
    arb_get_ubound_arf(bound, value_, 64);
    const double upper = arf_get_d(bound, ARF_RND_UP);
    arf_clear(bound);
    return upper;
  }
  std::string ToString() const {
    char* text = arb_get_str(value_, 25, 0);
    std::string copy(text);
    flint_free(text);
    return copy;
  }

 private:
  template <typename Operation>
  static Ball Apply(Operation operation, const Ball& x) {
    Ball result(0.0, x.bits_);
    operation(result.value_, x.value_, x.bits_);
    return result;
  }
  template <typename Operation>
  static Ball Apply(Operation operation, const Ball& x, const Ball& y) {
    Ball result(0.0, std::max(x.bits_, y.bits_));
    operation(result.value_, x.value_, y.value_, result.bits_);
    return result;
  }

  arb_t value_;
  slong bits_ = 53;
};

// The distance of `computed` from `exact` beyond `allowance`, in units in the last place of the exact value (never
// smaller than 2^-1074). An infinity stands for 2^1024, the double that would follow the largest one, and is the right
// double for exact values from there on. NaN is infinitely far away.
inline double ErrorInUlps(double computed, const Ball& exact, const Ball& allowance = Ball(0.0)) {
  constexpr double kNever = std::numeric_limits<double>::infinity();
  if (std::isnan(computed)) return kNever;
  const Ball limit = Ball::PowerOfTwo(1024);
  if (Abs(exact) >= limit) {
    const bool same_sign = (exact > Ball(0.0)) == (computed > 0.0);
    return std::isinf(computed) && same_sign ? 0.0 : kNever;
  }
  const Ball value = std::isinf(computed) ? (computed > 0.0 ? limit : -limit) : Ball(computed);
  const slong exponent = exact.ContainsZero() ? -1074 : std::max<slong>(exact.Exponent() - 53, -1074);
  const Ball wide(0.0, 512);
  const Ball error = (Abs(wide + value - exact) - allowance) / Ball::PowerOfTwo(exponent);
  return std::max(0.0, error.UpperBound());
}

}  // namespace ricochet

#endif  // RICOCHET_TESTS_SUPPORT_ORACLES_ARB_H_
