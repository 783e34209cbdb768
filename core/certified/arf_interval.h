// ArfInterval: a closed interval with ends of any precision and exponent, by Arb.
//
// Every operation encloses the exact results for all points of its operands: it rounds each end outward, to the larger
// of the operands' two precisions. An interval keeps two ends rather than a centre and a radius, because so it keeps
// the sign and the root of a wide interval. A quotient is the whole line if the divisor holds 0 inside, and a half-line
// if the divisor ends at 0.

#ifndef RICOCHET_CORE_CERTIFIED_ARF_INTERVAL_H_
#define RICOCHET_CORE_CERTIFIED_ARF_INTERVAL_H_

#include <utility>

#include "core/certified/flint.h"

namespace ricochet::certified {

// A binary floating-point number.
class Arf {
 public:
  Arf() { arf_init(value_); }
  explicit Arf(double exact) {
    arf_init(value_);
    arf_set_d(value_, exact);
  }
  Arf(const Arf& other) {
    arf_init(value_);
    arf_set(value_, other.value_);
  }
  Arf(Arf&& other) noexcept {
    arf_init(value_);
    arf_swap(value_, other.value_);
  }
  Arf& operator=(Arf other) noexcept {
    arf_swap(value_, other.value_);
    return *this;
  }
  ~Arf() { arf_clear(value_); }

  friend bool operator<(const Arf& x, const Arf& y) { return arf_cmp(x.value_, y.value_) < 0; }
  friend bool operator==(const Arf& x, const Arf& y) { return arf_equal(x.value_, y.value_) != 0; }
  int Sign() const { return arf_sgn(value_); }
  bool IsFinite() const { return arf_is_finite(value_) != 0; }

  arf_struct* get() { return value_; }
  const arf_struct* get() const { return value_; }

 private:
  arf_t value_;
};

class ArfInterval {
 public:
  ArfInterval() = default;
  // Implicit, so that formulas read like formulas.
  ArfInterval(double exact) : lower_(exact), upper_(exact) {}
  ArfInterval(Arf lower, Arf upper, slong bits) : lower_(std::move(lower)), upper_(std::move(upper)), bits_(bits) {}
  ArfInterval(const arb_t ball, slong bits) : bits_(bits) {
    arb_get_interval_arf(lower_.get(), upper_.get(), ball, bits);
  }

  friend ArfInterval operator+(const ArfInterval& x, const ArfInterval& y);
  friend ArfInterval operator-(const ArfInterval& x, const ArfInterval& y);
  friend ArfInterval operator*(const ArfInterval& x, const ArfInterval& y);
  friend ArfInterval operator/(const ArfInterval& x, const ArfInterval& y);
  friend ArfInterval operator-(const ArfInterval& x);
  // The root of the points that are not negative; there must be one.
  friend ArfInterval Sqrt(const ArfInterval& x);
  friend ArfInterval Square(const ArfInterval& x);
  friend ArfInterval Abs(const ArfInterval& x);
  friend ArfInterval Min(const ArfInterval& x, const ArfInterval& y);
  friend ArfInterval Max(const ArfInterval& x, const ArfInterval& y);
  friend ArfInterval Hull(const ArfInterval& x, const ArfInterval& y);
  // The points that are not negative, or not positive; there must be one.
  friend ArfInterval AtLeastZero(ArfInterval x);
  friend ArfInterval AtMostZero(ArfInterval x);

  const Arf& lower() const { return lower_; }
  const Arf& upper() const { return upper_; }

 private:
  Arf lower_, upper_;
  slong bits_ = 53;
};

}  // namespace ricochet::certified

#endif  // RICOCHET_CORE_CERTIFIED_ARF_INTERVAL_H_
