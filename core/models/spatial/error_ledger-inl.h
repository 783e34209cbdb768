// The ledger of errors: what truncation and rounding have done to the state so far, and what that does to the end.
//
// Two solutions of Coulomb's law approach each other in the norm of Wtt^-1, so that errors of the friction impulse add
// up and do not grow. Errors of v and of u by rounding grow with the length of the path. An event that is found at the
// wrong impulse adds that impulse error times the slopes. docs/theory/spatial.md derives the estimate.

// Per-target include guard.
#if defined(RICOCHET_CORE_MODELS_SPATIAL_ERROR_LEDGER_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef RICOCHET_CORE_MODELS_SPATIAL_ERROR_LEDGER_INL_H_
#undef RICOCHET_CORE_MODELS_SPATIAL_ERROR_LEDGER_INL_H_
#else
#define RICOCHET_CORE_MODELS_SPATIAL_ERROR_LEDGER_INL_H_
#endif

#include <algorithm>
#include <cmath>

#include "core/models/spatial/matrix-inl.h"
#include "core/models/spatial/path-inl.h"
#include "core/models/spatial/problem-inl.h"

HWY_BEFORE_NAMESPACE();
namespace ricochet::spatial::HWY_NAMESPACE {

template <typename T>
class ErrorLedger {
 public:
  explicit ErrorLedger(const ScaledProblem<T>& problem) : problem_(problem) {}

  // Adds an error of the friction impulse, in the norm sqrt(df^T Wtt df).
  void AddFrictionError(T error) { friction_ += error; }
  // The rounding of the direction of slip, in the same norm.
  T SlipRounding(T slip) const { return kEpsilon<T> * slip / problem_.smallest_root; }
  // Adds the turn of slip onto a direction that is off by `error` in that norm.
  void AddTurn(T error, T slip) {
    AddFrictionError(T{2} * error);
    work_ += slip * error;
  }
  // Adds a step of curved slip over the normal impulse `length` that ends with the velocity v.
  void AddStep(T friction_error, T work_error, T length, T v) {
    AddFrictionError(friction_error);
    work_ += problem_.normal_root * friction_ * length + work_error;
    v_rounding_ += kEpsilon<T> * (problem_.w.w33 * length + std::fabs(v));
  }
  // Adds a straight piece over `length`, with `slip` at its start and v at its end.
  void AddStraight(bool slips, T length, T slip, T v) {
    v_rounding_ += kEpsilon<T> * ((slips ? problem_.steepest : problem_.w.w33) * length + std::fabs(v));
    if (slips) u_rounding_ += kEpsilon<T> * (problem_.rate * length + slip);
    work_ += VelocityError() * length;
  }
  // Sets the distance from an event, in normal impulse, at which root finding stopped.
  void SetEventOffset(T offset) { event_offset_ = offset; }

  // Sets the slopes of the last straight slip, or of slip just before it stops.
  void SetSlopesOfSlip(const Slopes<T>& slopes) { slip_slopes_ = slopes; }
  // Slip stops at tau.
  void StopSlip(T tau) { stop_tau_ = tau; }
  // The contact sticks: errors of the path of u no longer matter.
  void Stick(const Sticking<T>& sticking);
  // Closes the account of compression, which ends at the state of `path` with these slopes.
  void EndCompression(const Path<T>& path, const Slopes<T>& slopes);
  // A bound on the error of each velocity at the end of the impact, relative to max(|u0|, |v0|).
  T EstimateAtEnd(const Path<T>& path, const Slopes<T>& slopes) const;

 private:
  T VelocityError() const { return problem_.normal_root * friction_ + v_rounding_; }
  // A bound on the error, in normal impulse, of the event at which v reaches its target. For a slope near 0 it is the
  // bound of a double root.
  T ImpulseErrorOfVelocityEvent(const Slopes<T>& slopes) const {
    const T error = VelocityError();
    return error == T{0} ? T{0} : error / std::max(slopes.v, std::sqrt(error));
  }
  T ImpulseErrorOfEnd(const Path<T>& path, const Slopes<T>& slopes) const;
  // The rounding of the normal work, whose terms may cancel.
  T WorkRounding(const State<T>& at) const {
    const T f = std::fabs(at.f1) + std::fabs(at.f2);
    return T{2} * kEpsilon<T> * (f + at.tau) * problem_.velocity;
  }

  const ScaledProblem<T>& problem_;
  // The scaled errors so far.
  T friction_{0};  // of the friction impulse, in the norm above
  T v_rounding_{0};
  T u_rounding_{0};
  T work_{0};                 // of the normal work in this phase
  T compression_impulse_{0};  // of the normal impulse at the end of compression
  T compression_work_{0};
  T event_offset_{0};
  T compression_end_v_{0};      // the v found in place of 0
  T stop_tau_ = -kInfinity<T>;  // where slip stopped, from the start of the phase
  Slopes<T> slip_slopes_ = {T{0}, T{0}, T{0}};
};

template <typename T>
void ErrorLedger<T>::Stick(const Sticking<T>& sticking) {
  friction_ = T{0};
  if (sticking.v_slope == T{0}) return;
  // A stop at the wrong impulse leaves in v the difference of the two slopes times the error of that impulse.
  const Slopes<T>& before = slip_slopes_;
  const T slowing = std::sqrt(before.u1 * before.u1 + before.u2 * before.u2);
  if (slowing > T{0}) v_rounding_ += std::fabs(before.v - sticking.v_slope) * (u_rounding_ / slowing);
  u_rounding_ = T{0};
}

template <typename T>
void ErrorLedger<T>::EndCompression(const Path<T>& path, const Slopes<T>& slopes) {
  compression_impulse_ = ImpulseErrorOfVelocityEvent(slopes) + event_offset_;
  compression_work_ = work_ + WorkRounding(path.state);
  compression_end_v_ = path.state.v;
  event_offset_ = work_ = T{0};
  stop_tau_ -= path.state.tau;
}

template <typename T>
T ErrorLedger<T>::ImpulseErrorOfEnd(const Path<T>& path, const Slopes<T>& slopes) const {
  const T coefficient = problem_.coefficient;
  if (coefficient == T{0}) return compression_impulse_;
  switch (path.goal.quantity) {
    case Quantity::kVelocity:
      return ImpulseErrorOfVelocityEvent(slopes);
    case Quantity::kImpulse:
      return (T{1} + coefficient) * compression_impulse_;
    case Quantity::kWork:
      break;
  }
  if (!(path.state.v > T{0})) return T{0};
  const T work = coefficient * coefficient * compression_work_ + work_ + WorkRounding(path.state);
  return (work + compression_end_v_ * compression_end_v_ / std::max(slopes.v, kEpsilon<T>)) / path.state.v;
}

template <typename T>
T ErrorLedger<T>::EstimateAtEnd(const Path<T>& path, const Slopes<T>& slopes) const {
  const T impulse = ImpulseErrorOfEnd(path, slopes) + event_offset_;
  const auto size = [](const Slopes<T>& of) { return std::sqrt(of.u1 * of.u1 + of.u2 * of.u2); };
  T u_slope = size(slopes);
  T v_slope = std::fabs(slopes.v);
  if (path.state.tau - stop_tau_ <= T{2} * impulse) {  // The impact may end before slip stops.
    u_slope = std::max(u_slope, size(slip_slopes_));
    v_slope = std::max(v_slope, std::fabs(slip_slopes_.v));
  }
  const T u_error = problem_.largest_root * friction_ + u_rounding_ + impulse * u_slope;
  // A v that ends the impact has its error from root finding alone.
  const bool v_is_goal = problem_.coefficient == T{0} || path.goal.quantity == Quantity::kVelocity;
  const T v_error = v_is_goal ? event_offset_ * v_slope : problem_.normal_root * friction_ + impulse * v_slope;
  constexpr T kOutput = T{4} * kEpsilon<T>;
  return (std::max(u_error, v_error) + T{2} * v_rounding_) / problem_.velocity + kOutput;
}

}  // namespace ricochet::spatial::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
