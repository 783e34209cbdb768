#include "core/certified/arf_interval.h"

#include <algorithm>
#include <array>

namespace ricochet::certified {
namespace {

// Returns x y. 0 times an infinite end is 0, because no point attains that end.
Arf Product(const Arf& x, const Arf& y, slong bits, arf_rnd_t rounding) {
  Arf product;
  if (x.Sign() != 0 && y.Sign() != 0) arf_mul(product.get(), x.get(), y.get(), bits, rounding);
  return product;
}

Arf Sum(const Arf& x, const Arf& y, slong bits, arf_rnd_t rounding) {
  Arf sum;
  arf_add(sum.get(), x.get(), y.get(), bits, rounding);
  return sum;
}

// Returns 1/x, or an infinity with the sign of `side` if x is 0.
Arf Inverse(const Arf& x, slong bits, arf_rnd_t rounding, int side) {
  Arf inverse;
  if (x.Sign() != 0) {
    arf_ui_div(inverse.get(), 1, x.get(), bits, rounding);
  } else if (side > 0) {
    arf_pos_inf(inverse.get());
  } else {
    arf_neg_inf(inverse.get());
  }
  return inverse;
}

Arf Infinite(int sign) { return Inverse(Arf(), 53, ARF_RND_NEAR, sign); }

Arf Root(const Arf& x, slong bits, arf_rnd_t rounding) {
  Arf root;
  if (x.Sign() > 0) arf_sqrt(root.get(), x.get(), bits, rounding);
  return root;
}

}  // namespace

ArfInterval operator+(const ArfInterval& x, const ArfInterval& y) {
  const slong bits = std::max(x.bits_, y.bits_);
  return {Sum(x.lower_, y.lower_, bits, ARF_RND_FLOOR), Sum(x.upper_, y.upper_, bits, ARF_RND_CEIL), bits};
}

ArfInterval operator-(const ArfInterval& x, const ArfInterval& y) { return x + -y; }

ArfInterval operator*(const ArfInterval& x, const ArfInterval& y) {
  const slong bits = std::max(x.bits_, y.bits_);
  const auto corners = [&](arf_rnd_t rounding) {
    return std::array{Product(x.lower_, y.lower_, bits, rounding), Product(x.lower_, y.upper_, bits, rounding),
                      Product(x.upper_, y.lower_, bits, rounding), Product(x.upper_, y.upper_, bits, rounding)};
  };
  const auto down = corners(ARF_RND_FLOOR);
  const auto up = corners(ARF_RND_CEIL);
  return {*std::min_element(down.begin(), down.end()), *std::max_element(up.begin(), up.end()), bits};
}

ArfInterval operator/(const ArfInterval& x, const ArfInterval& y) {
  const slong bits = std::max(x.bits_, y.bits_);
  if (y.lower_.Sign() < 0 && y.upper_.Sign() > 0) return {Infinite(-1), Infinite(1), bits};
  return x * ArfInterval(Inverse(y.upper_, bits, ARF_RND_FLOOR, -1), Inverse(y.lower_, bits, ARF_RND_CEIL, 1), bits);
}

ArfInterval operator-(const ArfInterval& x) {
  ArfInterval negative(x.upper_, x.lower_, x.bits_);
  arf_neg(negative.lower_.get(), negative.lower_.get());
  arf_neg(negative.upper_.get(), negative.upper_.get());
  return negative;
}

ArfInterval Sqrt(const ArfInterval& x) {
  return {Root(x.lower_, x.bits_, ARF_RND_FLOOR), Root(x.upper_, x.bits_, ARF_RND_CEIL), x.bits_};
}

ArfInterval Square(const ArfInterval& x) {
  const ArfInterval size = Abs(x);
  return size * size;
}

ArfInterval Abs(const ArfInterval& x) {
  if (x.lower_.Sign() >= 0) return x;
  const ArfInterval negative = -x;
  return x.upper_.Sign() <= 0 ? negative : Max(AtLeastZero(x), negative);
}

ArfInterval Min(const ArfInterval& x, const ArfInterval& y) {
  return {std::min(x.lower_, y.lower_), std::min(x.upper_, y.upper_), std::max(x.bits_, y.bits_)};
}

ArfInterval Max(const ArfInterval& x, const ArfInterval& y) {
  return {std::max(x.lower_, y.lower_), std::max(x.upper_, y.upper_), std::max(x.bits_, y.bits_)};
}

ArfInterval Hull(const ArfInterval& x, const ArfInterval& y) {
  return {std::min(x.lower_, y.lower_), std::max(x.upper_, y.upper_), std::max(x.bits_, y.bits_)};
}

ArfInterval AtLeastZero(ArfInterval x) {
  x.lower_ = std::max(x.lower_, Arf());
  return x;
}

ArfInterval AtMostZero(ArfInterval x) {
  x.upper_ = std::min(x.upper_, Arf());
  return x;
}

}  // namespace ricochet::certified
