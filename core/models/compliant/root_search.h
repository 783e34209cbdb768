// RootSearch: the first time at which a Signal turns negative.
//
// No root is missed: between two zeros of the fast sinusoid the signal has two roots at most, and the signs at both
// ends tell which (docs/theory/compliant.md, "Roots"). Stretches in which the slow sinusoid is above the amplitude of
// the fast one are skipped, however many fast periods long they are.

#ifndef RICOCHET_CORE_MODELS_COMPLIANT_ROOT_SEARCH_H_
#define RICOCHET_CORE_MODELS_COMPLIANT_ROOT_SEARCH_H_

#include <cmath>

#include "core/models/compliant/oscillation.h"

namespace ricochet::compliant {

// Returns the root between low and high of a function that is positive at low, not positive at high, and changes its
// sign once. Newton's method starts from `guess`; the bracket is halved where that leaves it or is too slow.
template <typename Function>
double RootBetween(double low, double high, double guess, const Function& function) {
  double t = guess > low && guess < high ? guess : 0.5 * (low + high);
  double last_step = high - low;
  for (int i = 0; i < 200; ++i) {
    const Value value = function(t);
    (value.f > 0.0 ? low : high) = t;
    double next = t - value.f / value.slope;
    // A slope of 0 makes a NaN, which must count as outside.
    const bool useful = next >= low && next <= high && std::fabs(next - t) < 0.5 * last_step;
    if (!useful) next = 0.5 * (low + high);
    last_step = std::fabs(next - t);
    if (last_step <= 0x1p-50 * std::fabs(t)) return next;
    t = next;
  }
  return t;
}

// The start of a search. f(time) > 0; with at_zero, f(time) = 0 and f > 0 just after. If rounding makes f(time) <= 0, a
// falling f is the root itself; otherwise f counts as 0.
struct SearchStart {
  double time = 0.0;
  bool at_zero = false;
};

class RootSearch {
 public:
  RootSearch(const Signal& signal, const Frequencies& w);

  // Says whether the amplitudes exceed the largest double. Nothing can be searched for then.
  bool overflows() const { return !std::isfinite(level_); }

  // Returns the first t in [start, horizon] where f turns negative, or kNever; NaN if it gives up.
  double First(const SearchStart& start, double horizon) const;

 private:
  struct Interval {
    double left, right;
  };

  // The time until which the slow sinusoid stays above the level: `t` itself if it is not above.
  double SkipFrom(double t) const;
  double NextZero(double t) const;
  Value Monotonic(const Interval& interval, double t) const;
  double Between(const Interval& interval, const Value& at_left, const Value& at_right, bool starts_at_zero) const;
  double LastRootBetween(const Interval& interval, const Value& at_left, const Value& at_right,
                         bool starts_at_zero) const;

  Signal signal_;
  Frequencies w_;
  double slow_angle_ = 0.0;  // Phase of the slow sinusoid.
  double first_zero_ = 0.0;  // Phase of the first zero of the fast sinusoid.
  double level_ = 0.0;       // A little above the fast amplitude.
  double high_angle_ = 0.0;  // The slow sinusoid is above the level for phases within this of its largest value.
};

}  // namespace ricochet::compliant

#endif  // RICOCHET_CORE_MODELS_COMPLIANT_ROOT_SEARCH_H_
