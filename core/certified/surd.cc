#include "core/certified/surd.h"

#include "core/base/invariant.h"

namespace ricochet::certified {

Surd operator+(const Surd& x, const Surd& y) {
  if (x.IsRational() && y.IsRational()) return x.a_ + y.a_;
  return {x.a_ + y.a_, x.b_ + y.b_, Surd::SharedRadicand(x, y)};
}

Surd operator-(const Surd& x, const Surd& y) { return x + -y; }

Surd operator*(const Surd& x, const Surd& y) {
  if (x.IsRational() && y.IsRational()) return x.a_ * y.a_;
  const Rational& d = Surd::SharedRadicand(x, y);
  return {x.a_ * y.a_ + x.b_ * y.b_ * d, x.a_ * y.b_ + x.b_ * y.a_, d};
}

Surd operator/(const Surd& x, const Surd& y) {
  if (y.IsRational()) return {x.a_ / y.a_, x.b_ / y.a_, x.d_};
  const Rational norm = y.Norm();
  return x * Surd(y.a_ / norm, -y.b_ / norm, y.d_);
}

Surd operator-(const Surd& x) { return {-x.a_, -x.b_, x.d_}; }

int Surd::Sign() const {
  const int a = a_.Sign();
  const int b = b_.Sign();
  if (b == 0 || a == b) return a;
  if (a == 0) return b;
  return Norm().Sign() > 0 ? a : b;
}

Surd Sqrt(const Surd& x) {
  CheckInvariant(x.IsRational() && x.Sign() >= 0, "the root of this number is no surd");
  if (x.a_.IsSquare()) return x.a_.Root();
  return {Rational(), 1.0, x.a_};
}

void Surd::Enclose(arb_t ball, slong bits) const {
  arb_set_fmpq(ball, a_.get(), bits);
  if (IsRational()) return;
  Ball own_root, own_part;
  arb_struct* const root = own_root.get();
  arb_struct* const part = own_part.get();
  arb_set_fmpq(root, d_.get(), bits);
  arb_sqrt(root, root, bits);
  arb_set_fmpq(part, b_.get(), bits);
  arb_mul(root, root, part, bits);
  if (a_.Sign() * b_.Sign() >= 0) {
    arb_add(ball, ball, root, bits);
  } else {
    arb_sub(root, ball, root, bits);
    arb_set_fmpq(part, Norm().get(), bits);
    arb_div(ball, part, root, bits);
  }
}

}  // namespace ricochet::certified
