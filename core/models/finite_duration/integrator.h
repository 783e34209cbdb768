// Integrator: one contact of finite duration, step by step, up to the roots of its guards.
//
// Its steps are those of Runge-Kutta formulas of orders 8 and 7, its roots those of TOMS 748 in Boost.Math. The size of
// a step follows from square roots alone, so that all machines take the same steps.

#ifndef RICOCHET_CORE_MODELS_FINITE_DURATION_INTEGRATOR_H_
#define RICOCHET_CORE_MODELS_FINITE_DURATION_INTEGRATOR_H_

#include <array>
#include <cstdint>
#include <optional>
#include <utility>

#include "core/models/finite_duration/guards.h"
#include "core/models/finite_duration/runge_kutta.h"

namespace ricochet::finite_duration {

class Integrator {
 public:
  explicit Integrator(const ScaledContact& contact) : contact_(contact) {}
  Integrator(const Integrator&) = delete;
  Integrator& operator=(const Integrator&) = delete;

  // Starts anew at s = 0, in `mode`.
  void Begin(const Mode& mode, const Motion& y, double tolerance);

  // Goes to the end of a step or the next root, and marks in `fallen` the guards that have fallen to 0 there, or are
  // below it. Returns false if no step is small enough, or a guard is NaN.
  bool Step(std::array<bool, kModeGuards>& fallen);

  const Motion& y() const { return y_; }
  double s() const { return s_; }
  double previous_s() const { return previous_s_; }
  // The motion anywhere in the last step.
  Motion Between(double s) { return After(s - previous_s_).y; }

  // Returns the sum of the sizes of the local errors of each part since the last call, as the formula of order 7
  // estimates them.
  Motion TakeLocalErrors() { return std::exchange(local_errors_, Motion{}); }
  // Returns the steps and the evaluations of the rates since the last call.
  int64_t right_hand_sides() const { return right_hand_sides_; }
  std::pair<int64_t, int64_t> TakeCosts() { return {std::exchange(steps_, 0), std::exchange(right_hand_sides_, 0)}; }

 private:
  using End = RungeKuttaEnd<kParts>;
  // The motion `h` after the start of the step, which begins at `before_`.
  End After(double h);
  // The size of the error of a step over the tolerance: a step is taken if it is at most 1.
  double SizeOf(const End& end) const;
  // The error of the step over that of the formula of order 7.
  double ShareOfOrder8(const End& end) const;
  bool TakeWholeStep(double& h, End& end);
  // A step of size `h` is watched by these numbers at a place in it.
  struct Watch {
    Motion rates;
    Guards value, slope;  // The guards, and how fast they change.
  };
  Watch WatchAt(const Motion& y, const Motion& rates, double h) const;
  // Cuts the step of size `h` at the first root in it, and returns what its end is watched by.
  Watch CutAtRoot(double& h, End& end);
  // Returns where in a step of size `h` the guard `i`, which has one sign at both ends, has another; nothing if it is
  // not seen to.
  std::optional<double> FindDip(size_t i, double h, const Watch& before, const Watch& after);
  bool IsNoise(size_t i, double before, double after);

  const ScaledContact& contact_;
  Mode mode_;
  double tolerance_ = 0.0;
  Motion absolute_ = {};  // Errors up to these times the tolerance count as small.
  Motion before_ = {}, y_ = {};
  Motion rates_before_ = {}, rates_ = {};
  Guards guards_ = {};
  Guards largest_ = {};  // The largest size of each guard in the mode.
  double s_ = 0.0, previous_s_ = 0.0;
  double next_size_ = 0.0;
  int64_t steps_ = 0, right_hand_sides_ = 0;
  Motion local_errors_ = {};
};

}  // namespace ricochet::finite_duration

#endif  // RICOCHET_CORE_MODELS_FINITE_DURATION_INTEGRATOR_H_
