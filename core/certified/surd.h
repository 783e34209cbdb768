// Surd: a + b sqrt(d) with rational a, b, d, exact.
//
// Every number of an impact has this form, and one d serves a whole impact: its events are rational in its inputs, and
// only the end of restitution under the energetic law takes a square root. Sums, products and quotients keep the form:
//   (a + b s)(e + f s) = (ae + bfd) + (af + be) s,   1/(a + b s) = (a - b s)/(a^2 - b^2 d),   s = sqrt(d).
// Signs are exact: if a and b differ in sign, a + b s has the sign of a where a^2 > b^2 d, and else the sign of b.

#ifndef RICOCHET_CORE_CERTIFIED_SURD_H_
#define RICOCHET_CORE_CERTIFIED_SURD_H_

#include <utility>

#include "core/certified/flint.h"
#include "core/certified/rational.h"

namespace ricochet::certified {

class Surd {
 public:
  Surd() = default;
  Surd(double exact) : a_(exact) {}
  Surd(Rational exact) : a_(std::move(exact)) {}

  // Two surds can be combined only if they have the same d or one of them is rational.
  friend Surd operator+(const Surd& x, const Surd& y);
  friend Surd operator-(const Surd& x, const Surd& y);
  friend Surd operator*(const Surd& x, const Surd& y);
  friend Surd operator/(const Surd& x, const Surd& y);
  friend Surd operator-(const Surd& x);

  int Sign() const;
  bool IsRational() const { return b_.Sign() == 0; }
  const Rational& rational_part() const { return a_; }

  // `x` must be rational and >= 0.
  friend Surd Sqrt(const Surd& x);
  friend Surd Square(const Surd& x) { return x * x; }
  friend Surd Abs(const Surd& x) { return x.Sign() < 0 ? -x : x; }
  friend Surd Min(const Surd& x, const Surd& y) { return (x - y).Sign() < 0 ? x : y; }
  friend Surd Max(const Surd& x, const Surd& y) { return (x - y).Sign() < 0 ? y : x; }
  // A branch that has been taken for >= 0 or <= 0 was decided exactly, so there is nothing to cut off.
  friend const Surd& AtLeastZero(const Surd& x) { return x; }
  friend const Surd& AtMostZero(const Surd& x) { return x; }

  // Sets `ball` to enclose the number with an error of a few units in the last of `bits`. It never adds two terms of
  // opposite sign, so nothing cancels.
  void Enclose(arb_t ball, slong bits) const;

 private:
  Surd(Rational a, Rational b, Rational d) : a_(std::move(a)), b_(std::move(b)), d_(std::move(d)) {}
  static const Rational& SharedRadicand(const Surd& x, const Surd& y) { return x.IsRational() ? y.d_ : x.d_; }
  Rational Norm() const { return a_ * a_ - b_ * b_ * d_; }

  Rational a_, b_, d_;  // If b is not 0, d is not the square of a rational.
};

}  // namespace ricochet::certified

#endif  // RICOCHET_CORE_CERTIFIED_SURD_H_
