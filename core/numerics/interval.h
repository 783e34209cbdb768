// Interval: the reals between two doubles, and operations whose result contains every result of the operands' members.
//
// Each end is the one that rounding down or up would give. It is the nearest double, or its neighbour if the sign of
// the rounding error says that the nearest lies on the wrong side; that error is itself exact (TwoSum, fma). An exact
// result does not widen, so an interval of one member stays one as long as arithmetic is exact. In the range of
// underflow, where the error is not known, the neighbour is always taken. The rounding mode is never touched;
// Boost.Interval, which does touch it, needs -frounding-math.
//
// Members are finite; an infinite end says that there is no bound. IsEmpty and Intersect alone are defined for an empty
// interval (lower > upper).

#ifndef RICOCHET_CORE_NUMERICS_INTERVAL_H_
#define RICOCHET_CORE_NUMERICS_INTERVAL_H_

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

namespace ricochet {

namespace rounding {

inline constexpr double kInfinity = std::numeric_limits<double>::infinity();
// The rounding error of a product, quotient or root above this size is exactly a double.
inline constexpr double kErrorIsExact = 0x1p-960;

// The neighbours of a double. They are inline because every operation calls them. An infinity has only one.
inline double Next(double value) {
  if (!(value < kInfinity)) return value;
  if (value == 0.0) return std::numeric_limits<double>::denorm_min();
  return std::bit_cast<double>(std::bit_cast<int64_t>(value) + (value > 0.0 ? 1 : -1));
}
inline double Previous(double value) { return -Next(-value); }

inline double Down(double value, double error) { return error >= 0.0 ? value : Previous(value); }
inline double Up(double value, double error) { return error <= 0.0 ? value : Next(value); }

struct Rounded {
  double value;
  double error;  // It has the sign of (exact - value), and is NaN if that sign is not known.
};

inline Rounded Add(double a, double b) {
  const double sum = a + b;
  const double b_part = sum - a;
  return {sum, (a - (sum - b_part)) + (b - b_part)};
}

inline Rounded Multiply(double a, double b) {
  // An infinite end is a bound, not a member: 0 times it is 0.
  if (a == 0.0 || b == 0.0) return {0.0, 0.0};
  const double product = a * b;
  const bool known = std::fabs(product) >= kErrorIsExact;
  return {product, known ? std::fma(a, b, -product) : std::numeric_limits<double>::quiet_NaN()};
}

// Requires b != 0.
inline Rounded Divide(double a, double b) {
  if (a == 0.0 || std::isinf(b)) return {0.0, 0.0};
  const double quotient = a / b;
  const bool known = std::fabs(a) >= kErrorIsExact && std::fabs(quotient) >= kErrorIsExact;
  const double remainder = std::fma(-quotient, b, a);
  return {quotient, known ? (b > 0.0 ? remainder : -remainder) : std::numeric_limits<double>::quiet_NaN()};
}

inline Rounded SquareRoot(double x) {
  if (x <= 0.0) return {0.0, 0.0};
  const double root = std::sqrt(x);
  return {root, x >= kErrorIsExact ? std::fma(-root, root, x) : std::numeric_limits<double>::quiet_NaN()};
}

}  // namespace rounding

struct Interval {
  double lower = 0.0;
  double upper = 0.0;

  constexpr Interval() = default;
  // A number is the interval that holds it alone.
  constexpr Interval(double value) : lower(value), upper(value) {}  // NOLINT(google-explicit-constructor)
  constexpr Interval(double low, double high) : lower(low), upper(high) {}

  friend bool operator==(const Interval&, const Interval&) = default;
};

inline bool IsEmpty(const Interval& x) { return !(x.lower <= x.upper); }
inline bool Contains(const Interval& x, double value) { return x.lower <= value && value <= x.upper; }
inline bool IsPoint(const Interval& x) { return x.lower == x.upper; }

// Returns a member of the interval, which is finite if an end is.
inline double Midpoint(const Interval& x) { return std::clamp(0.5 * x.lower + 0.5 * x.upper, x.lower, x.upper); }

inline Interval Intersect(const Interval& x, const Interval& y) {
  return {std::max(x.lower, y.lower), std::min(x.upper, y.upper)};
}

// The smallest interval that contains both.
inline Interval Hull(const Interval& x, const Interval& y) {
  return {std::min(x.lower, y.lower), std::max(x.upper, y.upper)};
}

inline Interval AtLeast(const Interval& x, double bound) { return {std::max(x.lower, bound), x.upper}; }
inline Interval AtMost(const Interval& x, double bound) { return {x.lower, std::min(x.upper, bound)}; }

inline Interval operator-(const Interval& x) { return {-x.upper, -x.lower}; }

inline Interval operator+(const Interval& x, const Interval& y) {
  const rounding::Rounded low = rounding::Add(x.lower, y.lower);
  const rounding::Rounded high = rounding::Add(x.upper, y.upper);
  return {rounding::Down(low.value, low.error), rounding::Up(high.value, high.error)};
}

inline Interval operator-(const Interval& x, const Interval& y) { return x + -y; }

// Returns x y, given which ends of x and y multiply to its ends.
inline Interval ProductOfEnds(double x_low, double y_low, double x_high, double y_high) {
  const rounding::Rounded low = rounding::Multiply(x_low, y_low);
  const rounding::Rounded high = rounding::Multiply(x_high, y_high);
  return {rounding::Down(low.value, low.error), rounding::Up(high.value, high.error)};
}

inline Interval operator*(const Interval& x, const Interval& y) {
  if (x.upper <= 0.0 && x.lower < 0.0) return -(-x * y);
  if (y.upper <= 0.0 && y.lower < 0.0) return -(x * -y);
  if (x.lower >= 0.0) return ProductOfEnds(y.lower >= 0.0 ? x.lower : x.upper, y.lower, x.upper, y.upper);
  if (y.lower >= 0.0) return ProductOfEnds(x.lower, y.upper, x.upper, y.upper);
  return Hull(ProductOfEnds(x.lower, y.upper, x.lower, y.lower), ProductOfEnds(x.upper, y.lower, x.upper, y.upper));
}

// Divides by the members of y other than 0; the result is unbounded if they come near 0.
inline Interval operator/(const Interval& x, const Interval& y) {
  if (y.lower < 0.0 && y.upper > 0.0) return {-rounding::kInfinity, rounding::kInfinity};
  if (y.upper <= 0.0 && y.lower < 0.0) return -x / -y;
  if (y.upper == 0.0) return {-rounding::kInfinity, rounding::kInfinity};
  const auto end = [](double a, double b) {
    return b == 0.0 ? rounding::Rounded{a == 0.0 ? 0.0 : std::copysign(rounding::kInfinity, a), 0.0}
                    : rounding::Divide(a, b);
  };
  const rounding::Rounded low = end(x.lower, x.lower < 0.0 ? y.lower : y.upper);
  const rounding::Rounded high = end(x.upper, x.upper < 0.0 ? y.upper : y.lower);
  return {rounding::Down(low.value, low.error), rounding::Up(high.value, high.error)};
}

inline Interval Square(const Interval& x) {
  const double far = std::max(std::fabs(x.lower), std::fabs(x.upper));
  const double near = Contains(x, 0.0) ? 0.0 : std::min(std::fabs(x.lower), std::fabs(x.upper));
  const rounding::Rounded low = rounding::Multiply(near, near);
  const rounding::Rounded high = rounding::Multiply(far, far);
  return {rounding::Down(low.value, low.error), rounding::Up(high.value, high.error)};
}

// The root of the members that are not negative.
inline Interval Sqrt(const Interval& x) {
  const rounding::Rounded low = rounding::SquareRoot(x.lower);
  const rounding::Rounded high = rounding::SquareRoot(x.upper);
  return {rounding::Down(low.value, low.error), rounding::Up(high.value, high.error)};
}

inline Interval Abs(const Interval& x) {
  if (x.lower >= 0.0) return x;
  if (x.upper <= 0.0) return -x;
  return {0.0, std::max(-x.lower, x.upper)};
}

}  // namespace ricochet

#endif  // RICOCHET_CORE_NUMERICS_INTERVAL_H_
