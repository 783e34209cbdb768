// The ledger of errors: what truncation and rounding have done to the state so far, and what that does to the end.
//
// The leading error of each step is known with its sign and carried along the path. Each such error has a doubt, a part
// of its own size, which is carried in the same way and counts in full. Rounding, and whatever the path carries in ways
// that are not linear, counts by the norm of Wtt^-1, in which solutions of Coulomb's law approach each other. An event
// that is found at the wrong impulse adds that impulse error times the slopes. docs/theory/spatial.md has the estimate.

// Per-target include guard.
#if defined(RICOCHET_CORE_MODELS_SPATIAL_ERROR_LEDGER_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef RICOCHET_CORE_MODELS_SPATIAL_ERROR_LEDGER_INL_H_
#undef RICOCHET_CORE_MODELS_SPATIAL_ERROR_LEDGER_INL_H_
#else
#define RICOCHET_CORE_MODELS_SPATIAL_ERROR_LEDGER_INL_H_
#endif

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/models/restitution_law.h"
#include "core/models/spatial/matrix-inl.h"
#include "core/models/spatial/path-inl.h"
#include "core/models/spatial/path_error-inl.h"
#include "core/models/spatial/problem-inl.h"

HWY_BEFORE_NAMESPACE();
namespace ricochet::spatial::HWY_NAMESPACE {

// The error of one step to leading order, and one like what that leaves out.
template <typename T>
struct StepError {
  PathError<T> known, rest;
};

template <typename T>
class ErrorLedger {
 public:
  explicit ErrorLedger(const ScaledProblem<T>& problem) : problem_(problem) {}

  // Adds an error of the friction impulse, in the norm sqrt(df^T Wtt df).
  void AddFrictionError(T error) { friction_ += error; }
  // The rounding of the direction of slip, in the same norm.
  T SlipRounding(T slip) const { return kEpsilon<T> * slip / problem_.smallest_root; }
  // Slip is turned by the friction impulse (f1, f2).
  void AddTurn(T f1, T f2) { AddKnown({.known = {.f1 = -f1, .f2 = -f2}, .rest = {}}); }
  // Adds a step of curved slip over the normal impulse `length`, from slip along e to slip along `next_e`.
  void AddStep(const StepError<T>& error, T length, const Direction<T>& e, T slip, const Direction<T>& next_e,
               T next_slip, T v);
  // Adds a straight piece over `length`, with `slip` along e at its start and v at its end.
  void AddStraightSlip(const Direction<T>& e, T length, T slip, T next_slip, T v);
  // Adds a piece without slip.
  void AddStick(T length, T v);
  // Adds a piece without friction.
  void AddFree(T length, T v) { AddRounding(problem_.w.w33 * length, v, length); }
  // Sets the distance from an event, in normal impulse, at which root finding stopped.
  void SetEventOffset(T offset) { event_offset_ = offset; }
  // Says that the path came so near to a goal, or so little beyond it, that the true path may not agree: `gap` is the
  // distance, in the goal's quantity, at the end of a step.
  void NoteGap(const Path<T>& path, T gap) { in_doubt_ = in_doubt_ || gap <= GoalError(path); }

  // Sets the slopes of the last straight slip, or of slip just before it stops.
  void SetSlopesOfSlip(const Slopes<T>& slopes) { slip_slopes_ = slopes; }
  // Slip stops at tau. What is known of its errors is no longer carried linearly.
  void StopSlip(T tau) {
    stop_tau_ = tau;
    CountByNorm();
  }
  void Stick(const Sticking<T>& sticking);
  // Closes the account of compression, which ends at the state of `path` with these slopes.
  void EndCompression(const Path<T>& path, const Slopes<T>& slopes);
  // The error of each velocity at the end of the impact, relative to max(|u0|, |v0|).
  T EstimateAtEnd(const Path<T>& path, const Slopes<T>& slopes) const;

 private:
  // The known error is a linear estimate of an error that is not: it counts so often, its doubt is this part of it, and
  // this part of it in addition counts by its norm, as an error of any direction.
  static constexpr T kSafety{2};
  static constexpr T kDoubt{0.5};
  static constexpr T kAnyDirection{0.13};

  // Errors of the end of compression: of its normal impulse and of its normal work.
  struct Compression {
    T impulse{0}, work{0};
  };

  void AddKnown(const StepError<T>& error);
  void AddRounding(T change_of_v, T v, T length) {
    v_rounding_ += kEpsilon<T> * (change_of_v + T{0.5} * std::fabs(v));
    work_ += VelocityError() * length;
  }
  void Carry(T m1, T m2, T length, const SlipSizes<T>& slip);
  void CountByNorm();
  T KnownSlipError() const;
  T VelocityError() const { return problem_.normal_root * friction_ + v_rounding_; }
  // A bound on the error, in normal impulse, of the event at which v reaches its target. For a slope near 0 it is the
  // bound of a double root.
  T ImpulseErrorOfVelocityEvent(T error, const Slopes<T>& slopes) const {
    return error == T{0} ? T{0} : error / std::max(slopes.v, std::sqrt(std::fabs(error)));
  }
  // The error of the impulse at the end, from that of the state there and that of compression.
  T ImpulseErrorOfEnd(const Path<T>& path, const Slopes<T>& slopes, T velocity_error, T work_error,
                      const Compression& compression) const;
  T SignedImpulseErrorOfEnd(const Path<T>& path, const Slopes<T>& slopes, const PathError<T>& error,
                            const Compression& compression) const {
    return -ImpulseErrorOfEnd(path, slopes, error.NormalVelocity(problem_.w), error.work, compression);
  }
  // The error of the goal's quantity at the state of `path`.
  T GoalError(const Path<T>& path) const;
  // The rounding of the normal work, whose terms may cancel.
  T WorkRounding(const State<T>& at) const {
    const T f = std::fabs(at.f1) + std::fabs(at.f2);
    return T{2} * kEpsilon<T> * (f + at.tau) * problem_.velocity;
  }
  static T Size(T x, T y) { return std::sqrt(x * x + y * y); }

  const ScaledProblem<T>& problem_;
  // The scaled errors so far.
  PathError<T> known_, doubtful_;
  Compression known_compression_, doubtful_compression_, compression_;
  T friction_{0};  // of the friction impulse, in the norm above
  T v_rounding_{0};
  T u_rounding_{0};
  T work_{0};  // of the normal work in this phase
  T event_offset_{0};
  T compression_end_v_{0};      // the v found in place of 0
  T stop_tau_ = -kInfinity<T>;  // where slip stopped, from the start of the phase
  T settles_{0};                // the normal impulse after which the true path sticks as well
  bool in_doubt_ = false;
  Slopes<T> slip_slopes_ = {T{0}, T{0}, T{0}};
};
template <typename T>
void ErrorLedger<T>::AddStep(const StepError<T>& error, T length, const Direction<T>& e, T slip,
                             const Direction<T>& next_e, T next_slip, T v) {
  Carry(e.c + next_e.c, e.s + next_e.s, length, {slip, next_slip});
  AddKnown(error);
  if (next_slip < T{4} * KnownSlipError()) CountByNorm();
  AddFrictionError(SlipRounding(slip));
  AddRounding(problem_.w.w33 * length, v, length);
}

template <typename T>
void ErrorLedger<T>::AddStraightSlip(const Direction<T>& e, T length, T slip, T next_slip, T v) {
  Carry(e.c, e.s, length, {slip, next_slip});
  u_rounding_ += kEpsilon<T> * (problem_.rate * length + T{0.5} * slip);
  AddRounding(T{2} * problem_.steepest * length, v, length);
}

// The true path sticks a little later, and is off by no more than before until then.
template <typename T>
void ErrorLedger<T>::AddStick(T length, T v) {
  const T unsettled = std::min(length, settles_);
  work_ += problem_.normal_root * friction_ * unsettled;
  if (!(settles_ > length)) friction_ = T{0};
  settles_ -= unsettled;
  v_rounding_ += kEpsilon<T> * (T{2} * problem_.w.w33 * length + T{0.5} * std::fabs(v));
  work_ += v_rounding_ * length;
}

// Doubts add up: they take the sign of the sum so far.
template <typename T>
void ErrorLedger<T>::AddKnown(const StepError<T>& error) {
  const Matrix<T>& w = problem_.w;
  known_.Add(error.known, T{1});
  AddFrictionError(kAnyDirection * error.known.Norm(w));
  for (const auto& [doubt, part] : {std::pair(&error.known, kDoubt), std::pair(&error.rest, T{1})}) {
    const T product = doubtful_.f1 * doubt->Velocity1(w) + doubtful_.f2 * doubt->Velocity2(w);
    doubtful_.Add(*doubt, std::copysign(part, product));
  }
}

template <typename T>
T ErrorLedger<T>::KnownSlipError() const {
  return Size(known_.Velocity1(problem_.w), known_.Velocity2(problem_.w));
}

// Carries the known error over slip in the direction of (m1, m2).
template <typename T>
void ErrorLedger<T>::Carry(T m1, T m2, T length, const SlipSizes<T>& slip) {
  if (known_.f1 == T{0} && known_.f2 == T{0}) return;
  const Decay<T> decay = DecayOver(problem_.w, problem_.mu, m1, m2, length, slip, KnownSlipError());
  known_.CarryOver(problem_.w, decay);
  doubtful_.CarryOver(problem_.w, decay);
}

template <typename T>
void ErrorLedger<T>::CountByNorm() {
  friction_ += known_.Norm(problem_.w) + doubtful_.Norm(problem_.w);
  known_.f1 = known_.f2 = doubtful_.f1 = doubtful_.f2 = T{0};
}

template <typename T>
void ErrorLedger<T>::Stick(const Sticking<T>& sticking) {
  const T margin = problem_.mu - Size(sticking.f1, sticking.f2);
  settles_ = friction_ == T{0} ? T{0} : margin > T{0} ? friction_ / (problem_.smallest_root * margin) : kInfinity<T>;
  if (sticking.v_slope == T{0}) friction_ = T{0};
  if (sticking.v_slope == T{0}) return;
  // A stop at the wrong impulse leaves in v the difference of the two slopes times the error of that impulse.
  const Slopes<T>& before = slip_slopes_;
  const T slowing = Size(before.u1, before.u2);
  if (slowing > T{0}) v_rounding_ += std::fabs(before.v - sticking.v_slope) * (u_rounding_ / slowing);
  u_rounding_ = T{0};
}

template <typename T>
void ErrorLedger<T>::EndCompression(const Path<T>& path, const Slopes<T>& slopes) {
  const T doubtful = std::fabs(doubtful_.NormalVelocity(problem_.w));
  compression_ = {.impulse = ImpulseErrorOfVelocityEvent(VelocityError() + doubtful, slopes) + event_offset_,
                  .work = work_ + std::fabs(doubtful_.work) + WorkRounding(path.state)};
  known_compression_ = {.impulse = ImpulseErrorOfVelocityEvent(known_.NormalVelocity(problem_.w), slopes),
                        .work = known_.work};
  compression_end_v_ = path.state.v;
  event_offset_ = work_ = known_.work = doubtful_.work = T{0};
  stop_tau_ -= path.state.tau;
}

template <typename T>
T ErrorLedger<T>::ImpulseErrorOfEnd(const Path<T>& path, const Slopes<T>& slopes, T velocity_error, T work_error,
                                    const Compression& compression) const {
  const T coefficient = problem_.coefficient;
  if (coefficient == T{0}) return compression.impulse;
  switch (path.goal.quantity) {
    case Quantity::kVelocity:
      return ImpulseErrorOfVelocityEvent(velocity_error, slopes);
    case Quantity::kImpulse:
      return (T{1} + coefficient) * compression.impulse;
    case Quantity::kWork:
      break;
  }
  if (!(path.state.v > T{0})) return T{0};
  return (work_error + coefficient * coefficient * compression.work) / path.state.v;
}

template <typename T>
T ErrorLedger<T>::GoalError(const Path<T>& path) const {
  const Matrix<T>& w = problem_.w;
  switch (path.goal.quantity) {
    case Quantity::kVelocity:
      return VelocityError() + kSafety * std::fabs(known_.NormalVelocity(w)) + std::fabs(doubtful_.NormalVelocity(w));
    case Quantity::kImpulse:
      return T{0};
    case Quantity::kWork:
      break;
  }
  return work_ + kSafety * std::fabs(known_.work) + std::fabs(doubtful_.work) + WorkRounding(path.state);
}

template <typename T>
T ErrorLedger<T>::EstimateAtEnd(const Path<T>& path, const Slopes<T>& slopes) const {
  // Restitution that has to give back work ends with v > 0, if the work of compression is known at all.
  const bool lost_work =
      problem_.coefficient > T{0} && path.goal.quantity == Quantity::kWork && !path.Sticks() && !(path.state.v > T{0});
  // Where friction locks the contact, slip and v vanish together, so that every path to it comes near to its goal.
  const bool in_doubt = in_doubt_ && path.regime != Regime::kLocked;
  if (in_doubt || lost_work) return kInfinity<T>;
  const Matrix<T>& w = problem_.w;
  // Poisson's impulse may have been spent at a v whose sign is in doubt.
  const bool v_is_turned = problem_.law == RestitutionLaw::kPoisson && path.goal.quantity == Quantity::kVelocity;
  const T v_found = v_is_turned ? std::fabs(compression_end_v_) + kSafety * std::fabs(known_.NormalVelocity(w)) : T{0};
  const T v_error_of_state = VelocityError() + std::fabs(doubtful_.NormalVelocity(w)) + v_found;
  const T jump = compression_end_v_ * compression_end_v_ / std::max(slopes.v, kEpsilon<T>);
  T impulse = ImpulseErrorOfEnd(path, slopes, v_error_of_state,
                                work_ + std::fabs(doubtful_.work) + WorkRounding(path.state) + jump, compression_) +
              event_offset_;
  const T known_impulse = SignedImpulseErrorOfEnd(path, slopes, known_, known_compression_);
  const T all = impulse + kSafety * std::fabs(known_impulse);
  T u_slope = Size(slopes.u1, slopes.u2);
  T v_slope = std::fabs(slopes.v);
  if (path.state.tau - stop_tau_ <= T{2} * all) {  // The impact may end before slip stops.
    impulse = all;
    u_slope = std::max(u_slope, Size(slip_slopes_.u1, slip_slopes_.u2));
    v_slope = std::max(v_slope, std::fabs(slip_slopes_.v));
  }
  const T known_u =
      Size(known_.Velocity1(w) + slopes.u1 * known_impulse, known_.Velocity2(w) + slopes.u2 * known_impulse);
  const T known_v = std::fabs(known_.NormalVelocity(w) + slopes.v * known_impulse);
  const T u_error = kSafety * known_u + Size(doubtful_.Velocity1(w), doubtful_.Velocity2(w)) +
                    problem_.largest_root * friction_ + u_rounding_ + impulse * u_slope;
  // A v that ends the impact has its error from root finding alone.
  const bool v_is_goal = problem_.coefficient == T{0} || (path.goal.quantity == Quantity::kVelocity && !v_is_turned);
  const T v_error = v_is_goal ? event_offset_ * v_slope : kSafety * known_v + v_error_of_state + impulse * v_slope;
  constexpr T kOutput = T{1.5} * kEpsilon<T>;
  return std::max(u_error, v_error) / problem_.velocity + kOutput;
}

}  // namespace ricochet::spatial::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
