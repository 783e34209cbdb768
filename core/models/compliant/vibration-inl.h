// Two oscillations in closed form, and the first time at which a sum of them vanishes: the stick of
// core/models/compliant/compliant.h.
//
//   f(t) = sum over i of a_i cos(w_i t) + b_i sin(w_i t)/w_i,   w_0 >= w_1 >= 0, w_0 > 0;   w_1 = 0: a_1 + b_1 t
//
// No root is missed. f'' + w_1^2 f is a multiple of the fast sinusoid alone, so it keeps its sign between two zeros of
// that. With h = cos(w_1 (t - middle)), positive in between because half a fast period is no longer than half a slow
// one, Polya's factors are
//
//   h (f'' + w_1^2 f) = m',   m = f' h - f h' = h^2 (f/h)'
//
// so there m is monotonic, f/h has one extremum at most and f two roots at most: the signs of f and m at both ends, and
// of f where m vanishes, tell which. And while the slow sinusoid is above the fast one's amplitude there is no root at
// all: such stretches, however many fast periods long, are skipped.

#ifndef RICOCHET_CORE_MODELS_COMPLIANT_VIBRATION_INL_H_
#define RICOCHET_CORE_MODELS_COMPLIANT_VIBRATION_INL_H_

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>

#include "core/numerics/elementary.h"

namespace ricochet::compliant::internal {

inline constexpr double kNever = std::numeric_limits<double>::infinity();

// What Angle is wrong by is well below.
inline constexpr double kAngleError = 0x1p-24;

// The angle in [-pi, pi] of the direction (x, y), 0 for (0, 0): a guess to 4e-3, then a step of Newton's method on
// sin(angle - guess), which leaves a sixth of the cube of that.
inline double Angle(double x, double y) {
  const double size = std::max(std::fabs(x), std::fabs(y));
  if (size == 0.0) return 0.0;
  const double c = x / size;
  const double s = y / size;
  const double low = std::min(std::fabs(c), std::fabs(s));
  double angle = low * (std::numbers::pi / 4.0 + 0.273 * (1.0 - low));
  if (std::fabs(s) > std::fabs(c)) angle = std::numbers::pi / 2.0 - angle;
  if (c < 0.0) angle = std::numbers::pi - angle;
  if (s < 0.0) angle = -angle;
  const double radius = std::sqrt(c * c + s * s);
  return angle + (s * Cos(angle) - c * Sin(angle)) / radius;
}

// What each oscillation is at one time: cos(w t), sin(w t)/w, and their integrals from 0.
struct Phase {
  std::array<double, 2> c, s, c_integral, s_integral;
};

struct Frequencies {
  double fast = 1.0;  // w_0
  double slow = 0.0;  // w_1

  double operator[](size_t i) const { return i == 0 ? fast : slow; }

  // Through half the angle, so that nothing cancels in the integral 2 sin^2(w t/2)/w^2.
  Phase At(double t) const {
    Phase phase = {};
    for (size_t i = 0; i < 2; ++i) {
      const double w = (*this)[i];
      const double sine = Sin(0.5 * w * t);
      const double cosine = Cos(0.5 * w * t);
      const double half = w > 0.0 ? sine / w : 0.5 * t;
      phase.c[i] = 1.0 - 2.0 * sine * sine;
      phase.s[i] = 2.0 * half * cosine;
      phase.c_integral[i] = phase.s[i];
      phase.s_integral[i] = 2.0 * half * half;
    }
    return phase;
  }
};

struct Value {
  double f = 0.0;
  double slope = 0.0;
};

// f(t).
struct Signal {
  std::array<double, 2> a = {};
  std::array<double, 2> b = {};

  Value At(const Frequencies& w, double t) const {
    Value value;
    for (size_t i = 0; i < 2; ++i) {
      const double cosine = Cos(w[i] * t);
      const double sine = w[i] > 0.0 ? Sin(w[i] * t) / w[i] : t;
      value.f += a[i] * cosine + b[i] * sine;
      value.slope += b[i] * cosine - w[i] * w[i] * a[i] * sine;
    }
    return value;
  }
};

// The root between low and high of a function that is positive at low, not so at high, and has no other change of sign
// in between: Newton's method from `guess`, or the bracket halved where that leaves it or is too slow.
template <typename Function>
double RootBetween(double low, double high, double guess, const Function& function) {
  double t = guess > low && guess < high ? guess : 0.5 * (low + high);
  double last_step = high - low;
  for (int i = 0; i < 200; ++i) {
    const Value value = function(t);
    (value.f > 0.0 ? low : high) = t;
    double next = t - value.f / value.slope;
    // Written so that a NaN, from a slope of 0, is outside.
    const bool useful = next >= low && next <= high && std::fabs(next - t) < 0.5 * last_step;
    if (!useful) next = 0.5 * (low + high);
    last_step = std::fabs(next - t);
    if (last_step <= 0x1p-50 * std::fabs(t)) return next;
    t = next;
  }
  return t;
}

// Where a search for a root begins: where f > 0, or where it is 0 and positive right after. What has a smaller f there
// is at the root if it falls, and else counts as 0.
struct Outset {
  double time = 0.0;
  bool at_zero = false;
};

// Looks for the first root of one signal, half a fast period at a time.
class RootSearch {
 public:
  RootSearch(const Signal& signal, const Frequencies& w) : signal_(signal), w_(w) {
    const double sine = signal.b[0] / w.fast;
    const double fast_amplitude = Hypot(signal.a[0], sine);
    first_zero_ = Angle(signal.a[0], sine) + std::numbers::pi / 2.0;
    const double slow_sine = w.slow > 0.0 ? signal.b[1] / w.slow : 0.0;
    const double slow_amplitude = Hypot(signal.a[1], slow_sine);
    // A little more than the fast amplitude, so that f is positive where a skip ends, whatever the rounding.
    level_ = fast_amplitude + 0x1p-40 * (slow_amplitude + fast_amplitude);
    if (w.slow == 0.0 || level_ >= slow_amplitude) return;
    slow_angle_ = Angle(signal.a[1], slow_sine);
    high_angle_ =
        Angle(level_, std::sqrt(slow_amplitude - level_) * std::sqrt(slow_amplitude + level_)) - 4.0 * kAngleError;
  }

  // Whether the amplitudes exceed the largest double. Nothing can be searched for then.
  bool overflows() const { return !std::isfinite(level_); }

  // The first t in [outset, horizon] where f turns negative, or kNever; NaN if it gives up.
  double First(const Outset& outset, double horizon) const {
    double left = outset.time;
    if (left >= horizon) return kNever;
    bool starts_at_zero = outset.at_zero;
    Value at_left = signal_.At(w_, left);
    if (starts_at_zero) {
      at_left.f = 0.0;
    } else if (at_left.f <= 0.0) {
      if (at_left.slope < 0.0) return left;
      starts_at_zero = true;
    }
    for (int i = 0; i < kMostIntervals; ++i) {
      const double skipped = SkipFrom(left);
      if (skipped >= horizon) return kNever;
      if (skipped > left) {
        left = skipped;
        at_left = signal_.At(w_, left);
        starts_at_zero = false;
      }
      const double right = std::min(NextZero(left), horizon);
      const Value at_right = signal_.At(w_, right);
      const double root = Between({left, right}, at_left, at_right, starts_at_zero);
      if (root <= right) return root;
      if (right >= horizon) return kNever;
      left = right;
      at_left = at_right;
      starts_at_zero = false;
    }
    return std::numeric_limits<double>::quiet_NaN();
  }

 private:
  // The slow part hovers at the fast amplitude for longer, or a double tells no fast period from the next any more.
  static constexpr int kMostIntervals = 1 << 10;

  struct Interval {
    double left, right;
  };

  // The time until which the slow sinusoid stays above the level: `t` itself if it is not above.
  double SkipFrom(double t) const {
    if (w_.slow > 0.0) {
      if (high_angle_ <= 0.0) return t;
      const double angle = w_.slow * t - slow_angle_;
      const double turns = std::nearbyint(angle / (2.0 * std::numbers::pi)) * 2.0 * std::numbers::pi;
      if (std::fabs(angle - turns) >= high_angle_) return t;
      return std::max(t, (turns + slow_angle_ + high_angle_) / w_.slow);
    }
    const double slow = signal_.a[1] + signal_.b[1] * t;
    if (slow <= level_) return t;
    return signal_.b[1] < 0.0 ? std::max(t, (level_ - signal_.a[1]) / signal_.b[1]) : kNever;
  }

  // The first zero of the fast sinusoid that is clearly behind `t`. In the sliver of the wrong sign that the error of
  // the angle leaves, f changes by the square of that.
  double NextZero(double t) const {
    const double phase = (w_.fast * t - first_zero_) / std::numbers::pi;
    return (first_zero_ + std::numbers::pi * (std::floor(phase + 2.0 * kAngleError) + 1.0)) / w_.fast;
  }

  // m(t) of the interval, and its slope.
  Value Monotonic(const Interval& interval, double t) const {
    const double offset = w_.slow * (t - 0.5 * (interval.left + interval.right));
    const Value f = signal_.At(w_, t);
    const double h = Cos(offset);
    const double fast = signal_.a[0] * Cos(w_.fast * t) + signal_.b[0] * (Sin(w_.fast * t) / w_.fast);
    return {.f = f.slope * h + f.f * w_.slow * Sin(offset),
            .slope = (w_.slow - w_.fast) * (w_.slow + w_.fast) * fast * h};
  }

  // The root of f where it turns negative in the interval, which has one fast zero at most, at its end; or kNever.
  double Between(const Interval& interval, const Value& at_left, const Value& at_right, bool starts_at_zero) const {
    const auto f = [this](double t) { return signal_.At(w_, t); };
    if (at_right.f <= 0.0) {
      double low = interval.left;
      double f_low = at_left.f;
      if (starts_at_zero) {
        low = RootBetween(low, interval.right, low, [&](double t) { return Monotonic(interval, t); });
        f_low = f(low).f;
        if (f_low <= 0.0) return low;
      }
      const double guess = interval.right - at_right.f * (interval.right - low) / (at_right.f - f_low);
      return RootBetween(low, interval.right, guess, f);
    }
    if (starts_at_zero) return kNever;
    const double half = 0.5 * w_.slow * (interval.right - interval.left);
    const double h = Cos(half);
    const double fall = w_.slow * Sin(half);
    const bool dips = at_left.slope * h - at_left.f * fall < 0.0 && at_right.slope * h + at_right.f * fall > 0.0;
    if (!dips) return kNever;
    const double lowest = RootBetween(interval.left, interval.right, interval.left, [&](double t) {
      const Value m = Monotonic(interval, t);
      return Value{.f = -m.f, .slope = -m.slope};
    });
    return f(lowest).f < 0.0 ? RootBetween(interval.left, lowest, interval.left, f) : kNever;
  }

  Signal signal_;
  Frequencies w_;
  double slow_angle_ = 0.0;
  double first_zero_ = 0.0;
  double level_ = 0.0;
  double high_angle_ = 0.0;
};

}  // namespace ricochet::compliant::internal

#endif  // RICOCHET_CORE_MODELS_COMPLIANT_VIBRATION_INL_H_
