// AffineInterval: a function of the parameters of a box, enclosed to first order.
//
// For every point x of a box with the centre c, f(x) lies in f(c) + sum_i s_i (x_i - c_i), where the s_i are the
// slopes. Sums, products and quotients carry the slopes on exactly (Krawczyk and Neumaier 1985); the derivative bounds
// those of another function. The range is the intersection of what the slopes allow with what interval arithmetic
// allows. If parameters enter a formula several times, it is too wide by the square of the box's size rather than by
// the size. All operations are rounded outward (core/numerics/interval.h).
//
// Parameters beyond the first kMostSlopes have no slopes; they are intervals at the centre, too.

#ifndef RICOCHET_CORE_NUMERICS_AFFINE_INTERVAL_H_
#define RICOCHET_CORE_NUMERICS_AFFINE_INTERVAL_H_

#include <array>
#include <cstddef>

#include "core/numerics/interval.h"
#include "core/numerics/interval_elementary.h"

namespace ricochet {

// The parameters that have slopes.
class SlopeParameters {
 public:
  static constexpr size_t kMostSlopes = 8;

  size_t size() const { return size_; }
  // x_i - c_i
  const Interval& offset(size_t i) const { return offsets_[i]; }

 private:
  friend class AffineInterval;
  size_t size_ = 0;
  std::array<Interval, kMostSlopes> offsets_;
};

class AffineInterval {
 public:
  AffineInterval() = default;
  // A number that is the same all over the box, or of which nothing but this range is known.
  AffineInterval(const Interval& value) : centre_(value), range_(value) {}  // NOLINT(google-explicit-constructor)

  AffineInterval(double value) : AffineInterval(Interval(value)) {}  // NOLINT(google-explicit-constructor)
  // A further parameter of the box. `parameters` must outlive every form that is computed from it.
  static AffineInterval Parameter(const Interval& range, SlopeParameters& parameters) {
    if (IsPoint(range) || parameters.size_ == SlopeParameters::kMostSlopes) return range;
    const size_t i = parameters.size_++;
    AffineInterval form;
    form.parameters_ = &parameters;
    form.centre_ = Midpoint(range);
    form.range_ = range;
    form.slopes_[i] = 1.0;
    parameters.offsets_[i] = range - form.centre_;
    return form;
  }

  const Interval& centre() const { return centre_; }
  const Interval& range() const { return range_; }

  // Cuts the range to the limits in which the function is known to lie.
  friend AffineInterval Within(AffineInterval x, const Interval& limits) {
    x.range_ = Intersect(x.range_, limits);
    return x;
  }

  friend AffineInterval operator-(const AffineInterval& x) { return AffineInterval(0.0) - x; }
  friend AffineInterval operator+(const AffineInterval& x, const AffineInterval& y) {
    return Make(x, y, x.centre_ + y.centre_, x.range_ + y.range_,
                [&](size_t i) { return x.slopes_[i] + y.slopes_[i]; });
  }
  friend AffineInterval operator-(const AffineInterval& x, const AffineInterval& y) {
    return Make(x, y, x.centre_ - y.centre_, x.range_ - y.range_,
                [&](size_t i) { return x.slopes_[i] - y.slopes_[i]; });
  }
  // x y - x_c y_c = (x - x_c) y + x_c (y - y_c)
  friend AffineInterval operator*(const AffineInterval& x, const AffineInterval& y) {
    return Make(x, y, x.centre_ * y.centre_, x.range_ * y.range_,
                [&](size_t i) { return x.slopes_[i] * y.range_ + x.centre_ * y.slopes_[i]; });
  }
  // x/y - q = (x - x_c - q (y - y_c))/y, q = x_c/y_c
  friend AffineInterval operator/(const AffineInterval& x, const AffineInterval& y) {
    const Interval q = x.centre_ / y.centre_;
    return Make(x, y, q, x.range_ / y.range_, [&](size_t i) { return (x.slopes_[i] - q * y.slopes_[i]) / y.range_; });
  }
  // x^2 - x_c^2 = (x - x_c)(x + x_c)
  friend AffineInterval Square(const AffineInterval& x) {
    return Make(x, x, Square(x.centre_), Square(x.range_),
                [&](size_t i) { return x.slopes_[i] * (x.range_ + x.centre_); });
  }
  // The root of the members that are not negative: sqrt(x) - sqrt(x_c) = (x - x_c)/(sqrt(x) + sqrt(x_c)).
  friend AffineInterval Sqrt(const AffineInterval& x) {
    const Interval centre = Sqrt(x.centre_);
    const Interval range = Sqrt(x.range_);
    return Make(x, x, centre, range, [&](size_t i) { return x.slopes_[i] / (range + centre); });
  }
  friend AffineInterval Sin(const AffineInterval& x) { return x.Through(Sin(x.centre_), Sin(x.range_), Cos(x.range_)); }
  friend AffineInterval Cos(const AffineInterval& x) {
    return x.Through(Cos(x.centre_), Cos(x.range_), -Sin(x.range_));
  }
  // Requires x >= 0.
  friend AffineInterval Pow(const AffineInterval& x, double exponent) {
    return x.Through(Pow(x.centre_, exponent), Pow(x.range_, exponent),
                     Interval(exponent) * Pow(x.range_, exponent - 1.0));
  }

  // Returns a function of this form, given the function's value at the centre, its range and its derivative.
  AffineInterval Through(const Interval& centre, const Interval& range, const Interval& slope) const {
    return Make(*this, *this, centre, range, [&](size_t i) { return slopes_[i] * slope; });
  }

 private:
  template <typename SlopeOf>
  static AffineInterval Make(const AffineInterval& x, const AffineInterval& y, const Interval& centre,
                             const Interval& range, SlopeOf slope_of) {
    AffineInterval form;
    form.parameters_ = x.parameters_ != nullptr ? x.parameters_ : y.parameters_;
    form.centre_ = centre;
    form.range_ = range;
    if (form.parameters_ == nullptr) return form;
    Interval linear = centre;
    for (size_t i = 0; i < form.parameters_->size(); ++i) {
      if (x.slopes_[i] == Interval() && y.slopes_[i] == Interval()) continue;
      form.slopes_[i] = slope_of(i);
      linear = linear + form.slopes_[i] * form.parameters_->offset(i);
    }
    form.range_ = Intersect(range, linear);
    return form;
  }

  const SlopeParameters* parameters_ = nullptr;  // Null for a number that is the same all over the box.
  Interval centre_, range_;
  std::array<Interval, SlopeParameters::kMostSlopes> slopes_;
};

}  // namespace ricochet

#endif  // RICOCHET_CORE_NUMERICS_AFFINE_INTERVAL_H_
