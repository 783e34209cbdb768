// Rational: an exact quotient of integers of any size, by FLINT.
//
// Every finite double is a rational, and so is every result of +, -, * and / on them. A sign is never in doubt.

#ifndef RICOCHET_CORE_CERTIFIED_RATIONAL_H_
#define RICOCHET_CORE_CERTIFIED_RATIONAL_H_

#include <cmath>

#include "core/base/invariant.h"
#include "core/certified/flint.h"

namespace ricochet::certified {

class Rational {
 public:
  Rational() { fmpq_init(value_); }
  // Implicit, so that formulas read like formulas. `exact` must be finite.
  Rational(double exact) {
    CheckInvariant(std::isfinite(exact), "an infinity or a NaN is no rational number");
    fmpq_init(value_);
    int exponent = 0;
    const double fraction = std::frexp(exact, &exponent);
    fmpz_set_d(fmpq_numref(value_), std::ldexp(fraction, 53));
    if (exponent >= 53) {
      fmpq_mul_2exp(value_, value_, static_cast<ulong>(exponent - 53));
    } else {
      fmpq_div_2exp(value_, value_, static_cast<ulong>(53 - exponent));
    }
  }
  Rational(const Rational& other) {
    fmpq_init(value_);
    fmpq_set(value_, other.value_);
  }
  Rational(Rational&& other) noexcept {
    fmpq_init(value_);
    fmpq_swap(value_, other.value_);
  }
  Rational& operator=(Rational other) noexcept {
    fmpq_swap(value_, other.value_);
    return *this;
  }
  ~Rational() { fmpq_clear(value_); }

  friend Rational operator+(const Rational& x, const Rational& y) { return Apply(fmpq_add, x, y); }
  friend Rational operator-(const Rational& x, const Rational& y) { return Apply(fmpq_sub, x, y); }
  friend Rational operator*(const Rational& x, const Rational& y) { return Apply(fmpq_mul, x, y); }
  // `y` must not be 0.
  friend Rational operator/(const Rational& x, const Rational& y) { return Apply(fmpq_div, x, y); }
  friend Rational operator-(Rational x) {
    fmpq_neg(x.value_, x.value_);
    return x;
  }

  int Sign() const { return fmpq_sgn(value_); }
  bool IsSquare() const { return fmpz_is_square(fmpq_numref(value_)) && fmpz_is_square(fmpq_denref(value_)); }
  // The root of a number for which IsSquare holds.
  Rational Root() const {
    Rational root;
    fmpz_sqrt(fmpq_numref(root.value_), fmpq_numref(value_));
    fmpz_sqrt(fmpq_denref(root.value_), fmpq_denref(value_));
    return root;
  }

  fmpq* get() { return value_; }
  const fmpq* get() const { return value_; }

 private:
  template <typename Operation>
  static Rational Apply(Operation operation, const Rational& x, const Rational& y) {
    Rational result;
    operation(result.value_, x.value_, y.value_);
    return result;
  }

  fmpq_t value_;
};

}  // namespace ricochet::certified

#endif  // RICOCHET_CORE_CERTIFIED_RATIONAL_H_
