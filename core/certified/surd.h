// Surd: a + b sqrt(d) with rational a, b, d, exact.
//
// All that an impact comes to is of this form, with one d an impact: its events are rational in its inputs, but that
// the energetic end of restitution takes one square root. Sums, products and quotients stay in the form,
//   (a + b s)(e + f s) = (ae + bfd) + (af + be) s,   1/(a + b s) = (a - b s)/(a^2 - b^2 d),   s = sqrt(d),
// and signs are exact: where a and b differ in sign, a + b s has that of the larger of a^2 and b^2 d.

#ifndef RICOCHET_CORE_CERTIFIED_SURD_H_
#define RICOCHET_CORE_CERTIFIED_SURD_H_

#include <arb.h>

#include <utility>

#include "core/certified/rational.h"

namespace ricochet::certified {

class Surd {
 public:
  Surd() = default;
  Surd(double exact) : a_(exact) {}
  Surd(Rational exact) : a_(std::move(exact)) {}

  // Two surds that are combined have the same d, or one of them is rational.
  friend Surd operator+(const Surd& x, const Surd& y);
  friend Surd operator-(const Surd& x, const Surd& y);
  friend Surd operator*(const Surd& x, const Surd& y);
  friend Surd operator/(const Surd& x, const Surd& y);
  friend Surd operator-(const Surd& x);

  int Sign() const;
  bool IsRational() const { return b_.Sign() == 0; }
  const Rational& rational_part() const { return a_; }

  // `x` is rational and >= 0.
  friend Surd Sqrt(const Surd& x);
  friend Surd Square(const Surd& x) { return x * x; }
  friend Surd Abs(const Surd& x) { return x.Sign() < 0 ? -x : x; }
  friend Surd Min(const Surd& x, const Surd& y) { return (x - y).Sign() < 0 ? x : y; }
  friend Surd Max(const Surd& x, const Surd& y) { return (x - y).Sign() < 0 ? y : x; }
  // What a branch has taken for >= 0 or <= 0 is so.
  friend const Surd& AtLeastZero(const Surd& x) { return x; }
  friend const Surd& AtMostZero(const Surd& x) { return x; }

  // A ball around it with an error of a few units in the last of `bits`: no two terms of opposite sign are added.
  void Enclose(arb_t ball, slong bits) const;

 private:
  Surd(Rational a, Rational b, Rational d) : a_(std::move(a)), b_(std::move(b)), d_(std::move(d)) {}
  static const Rational& SharedRadicand(const Surd& x, const Surd& y) { return x.IsRational() ? y.d_ : x.d_; }
  Rational Norm() const { return a_ * a_ - b_ * b_ * d_; }

  Rational a_, b_, d_;  // d is no square where b is not 0.
};

}  // namespace ricochet::certified

#endif  // RICOCHET_CORE_CERTIFIED_SURD_H_
