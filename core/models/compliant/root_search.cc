#include "core/models/compliant/root_search.h"

#include <algorithm>
#include <limits>
#include <numbers>

#include "core/numerics/elementary.h"

namespace ricochet::compliant {
namespace {

// The search gives up after so many intervals. The slow part then hovers at the fast amplitude, or doubles cannot tell
// one fast period from the next any more.
constexpr int kMostIntervals = 1 << 10;

}  // namespace

RootSearch::RootSearch(const Signal& signal, const Frequencies& w) : signal_(signal), w_(w) {
  const double sine = signal.b[0] / w.fast;
  const double fast_amplitude = Hypot(signal.a[0], sine);
  first_zero_ = Angle(signal.a[0], sine) + std::numbers::pi / 2.0;
  const double slow_sine = w.slow > 0.0 ? signal.b[1] / w.slow : 0.0;
  const double slow_amplitude = Hypot(signal.a[1], slow_sine);
  // The margin makes f positive where a skip ends, whatever the rounding.
  level_ = fast_amplitude + 0x1p-40 * (slow_amplitude + fast_amplitude);
  if (w.slow == 0.0 || level_ >= slow_amplitude) return;
  slow_angle_ = Angle(signal.a[1], slow_sine);
  high_angle_ =
      Angle(level_, std::sqrt(slow_amplitude - level_) * std::sqrt(slow_amplitude + level_)) - 4.0 * kAngleError;
}

double RootSearch::First(const SearchStart& start, double horizon) const {
  double left = start.time;
  if (left >= horizon) return kNever;
  bool starts_at_zero = start.at_zero;
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

double RootSearch::SkipFrom(double t) const {
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

// The first zero of the fast sinusoid that is clearly behind `t`. The error of the angle leaves a sliver of the wrong
// sign, in which f changes by the square of that error only.
double RootSearch::NextZero(double t) const {
  const double phase = (w_.fast * t - first_zero_) / std::numbers::pi;
  return (first_zero_ + std::numbers::pi * (std::floor(phase + 2.0 * kAngleError) + 1.0)) / w_.fast;
}

// The function m of docs/theory/compliant.md, which is monotonic in the interval, and its slope.
Value RootSearch::Monotonic(const Interval& interval, double t) const {
  const double offset = w_.slow * (t - 0.5 * (interval.left + interval.right));
  const Value f = signal_.At(w_, t);
  const double h = Cos(offset);
  const double fast = signal_.a[0] * Cos(w_.fast * t) + signal_.b[0] * (Sin(w_.fast * t) / w_.fast);
  return {.f = f.slope * h + f.f * w_.slow * Sin(offset),
          .slope = (w_.slow - w_.fast) * (w_.slow + w_.fast) * fast * h};
}

// The root where f turns negative in an interval that has one zero of the fast sinusoid at most, at its end; or kNever.
double RootSearch::Between(const Interval& interval, const Value& at_left, const Value& at_right,
                           bool starts_at_zero) const {
  if (at_right.f <= 0.0) return LastRootBetween(interval, at_left, at_right, starts_at_zero);
  if (starts_at_zero) return kNever;
  const double half = 0.5 * w_.slow * (interval.right - interval.left);
  const double h = Cos(half);
  const double fall = w_.slow * Sin(half);
  const bool dips = at_left.slope * h - at_left.f * fall < 0.0 && at_right.slope * h + at_right.f * fall > 0.0;
  if (!dips) return kNever;
  const auto f = [this](double t) { return signal_.At(w_, t); };
  const double lowest = RootBetween(interval.left, interval.right, interval.left, [&](double t) {
    const Value m = Monotonic(interval, t);
    return Value{.f = -m.f, .slope = -m.slope};
  });
  return f(lowest).f < 0.0 ? RootBetween(interval.left, lowest, interval.left, f) : kNever;
}

// The only root of an f that is not positive at the right end. A start at 0 is no root: f rises there first.
double RootSearch::LastRootBetween(const Interval& interval, const Value& at_left, const Value& at_right,
                                   bool starts_at_zero) const {
  const auto f = [this](double t) { return signal_.At(w_, t); };
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

}  // namespace ricochet::compliant
