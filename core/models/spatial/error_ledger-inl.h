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

#include "core/models/restitution_law.h"
#include "core/models/spatial/matrix-inl.h"
#include "core/models/spatial/path-inl.h"
#include "core/models/spatial/path_error-inl.h"
#include "core/models/spatial/problem-inl.h"
#include "core/models/spatial/step_errors-inl.h"

HWY_BEFORE_NAMESPACE();
namespace ricochet::spatial::HWY_NAMESPACE {

// Errors of an impact, in the units of the scaled problem: works of friction and the change of energy in that of
// friction.
template <typename T>
struct EndErrors {
  T relative{0};  // the larger of the errors of u and v, over max(|u0|, |v0|)
  T u{0}, v{0};
  T tau_compression{0}, tau{0}, f{0};
  T normal_compression{0}, normal_restitution{0};
  T tangential_compression{0}, tangential_restitution{0}, energy{0};
};

template <typename T>
class ErrorLedger {  // NOLINT(clang-analyzer-optin.performance.Padding): one stands in an impact at a time.
 public:
  explicit ErrorLedger(const ScaledProblem<T>& problem) : problem_(problem) {}

  // The errors before a step of slip that turns, and those after it.
  const StepErrors<T>& BeforeStep() const { return sum_; }
  void SetAfterStep(const StepErrors<T>& errors) { sum_ = errors; }
  // Adds the rounding of the direction of slip.
  void AddSlipRounding(T slip) { sum_.slip_rounding += StepErrors<T>::SlipRounding(problem_, slip); }
  // Slip is turned by the friction impulse (f1, f2).
  void AddTurn(T f1, T f2) { sum_.AddKnown(problem_.w, {.known = {.f1 = -f1, .f2 = -f2}, .remainder = {}}); }
  // Adds a straight piece over `length`, with `slip` along e at its start and v at its end.
  void AddStraightSlip(const Direction<T>& e, T length, T slip, T next_slip, T v);
  // Adds a piece without slip.
  void AddStick(T length, T v);
  // Adds a piece without friction.
  void AddFree(T length, T v) {
    u_rounding_ += kEpsilon<T> * (problem_.rate * length * problem_.graze + T{0.5} * problem_.velocity);
    sum_.AddRounding(problem_, problem_.w.w33 * length, v, length);
  }
  // Sets the distance from an event, in normal impulse, at which root finding stopped.
  void SetEventDistance(T distance) { event_distance_ = distance; }
  // Says that the path came so near to a goal, or so little beyond it, that the true path may not agree: `gap` is the
  // distance, in the goal's quantity, at the end of a step. Where the contact is nearly at rest, the paths on both
  // sides of the goal stay as near to each other as they are to rest.
  void NoteGap(const Path<T>& path, T gap) {
    if (!(gap <= GoalError(path, path.goal.quantity))) return;
    const T velocity = path.state.Slip() + std::fabs(path.state.v);
    in_doubt_ = in_doubt_ || velocity > T{kNearRest} * problem_.velocity;
    doubtful_velocity_ = std::max(doubtful_velocity_, velocity);
  }

  // Sets the slopes of the last straight slip, or of slip just before it stops.
  void SetSlopesOfSlip(const Slopes<T>& slopes) { slip_slopes_ = slopes; }
  // Slip stops at tau. What is known of its errors is no longer carried linearly.
  void StopSlip(T tau) {
    stop_tau_ = tau;
    sum_.CountByNorm(problem_.w, true);
    const T slowing = Size(slip_slopes_.u1, slip_slopes_.u2);
    if (slowing > T{0}) f_rounding_ += T{2} * problem_.mu_static * (u_rounding_ / slowing);
  }
  void Stick(const Sticking<T>& sticking);
  // Closes the account of compression, which ends at the state of `path` with these slopes.
  void EndCompression(const Path<T>& path, const Slopes<T>& slopes);
  // The errors at the end of the impact; infinite if nothing is known of them.
  EndErrors<T> AtEnd(const Path<T>& path, const Slopes<T>& slopes) const;

 private:
  // The known error is a linear estimate of a nonlinear error, so it counts this often. In impulses and works, which
  // have no other number whose error is larger, it counts more often.
  static constexpr T kSafety{2};
  static constexpr T kSafetyOfImpulses{4};
  // The part of the known errors that counts for a velocity by itself, in addition.
  static constexpr T kOfParts{0.5};
  // A contact is nearly at rest below this part of its velocity before.
  static constexpr double kNearRest = 1e-6;

  // Errors of the end of compression: of its normal impulse and of its normal work.
  struct Compression {
    T impulse{0}, work{0};
  };

  T VelocityError() const { return sum_.VelocityError(problem_); }
  // A contact that sticks does not depend on the path of u.
  void ForgetSlip() { sum_.friction = sum_.slip_rounding = sum_.strayed = T{0}; }
  // A bound on the error, in normal impulse, of the event at which v reaches its target: the root of a parabola, or the
  // bound of a double root where that is not real.
  T ImpulseErrorOfVelocityEvent(T error, const Slopes<T>& slopes) const {
    if (error == T{0}) return T{0};
    const T bend = slopes.v > T{0} ? slopes.bend : T{1};
    const T change = T{2} * bend * std::fabs(error);
    const T square = slopes.v * slopes.v - change;
    if (slopes.v > T{0} && square >= T{0}) return T{2} * error / (slopes.v + std::sqrt(square));
    return T{2} * error / std::sqrt(change);
  }
  // The error of the impulse at the end, from that of the state there and that of compression.
  T ImpulseErrorOfEnd(const Path<T>& path, const Slopes<T>& slopes, T velocity_error, T work_error,
                      const Compression& compression) const;
  T SignedImpulseErrorOfEnd(const Path<T>& path, const Slopes<T>& slopes, const PathError<T>& error,
                            const Compression& compression) const {
    return -ImpulseErrorOfEnd(path, slopes, error.NormalVelocity(problem_.w), error.work, compression);
  }
  // The error of a quantity at the state of `path`.
  T GoalError(const Path<T>& path, Quantity quantity) const;
  // The normal impulse of the phase while the contact slips.
  T SlipOfPhase(const Path<T>& path) const {
    return path.Sticks() ? std::clamp(stop_tau_, T{0}, path.state.tau) : path.state.tau;
  }
  // The friction impulse for each unit of normal impulse, where the state of `path` is.
  T FrictionRatio(const Path<T>& path) const { return path.Sticks() ? holding_ : problem_.mu_static; }
  // A bound on the friction impulse so far.
  T MostFriction(const Path<T>& path) const {
    const T tau = compression_end_tau_ + path.state.tau;
    const T slip = path.Sticks() ? std::clamp(compression_end_tau_ + stop_tau_, T{0}, tau) : tau;
    return problem_.mu_static * slip + holding_ * (tau - slip);
  }
  // The rounding of the normal work, which is the mean of v times tau less what u lacks of its mean: over an impulse
  // both change by at most their slopes times the impulse. A contact that sticks has no u.
  T WorkRounding(const Path<T>& path) const {
    const State<T>& at = path.state;
    const T slip = SlipOfPhase(path);
    const T v_change = problem_.steepest * slip + problem_.w.w33 * (at.tau - slip);
    return T{4} * kEpsilon<T> *
           (at.tau * (std::max(problem_.approach, std::fabs(at.v)) + v_change) +
            problem_.graze * problem_.mu * problem_.rate * slip * slip);
  }
  // The errors of u, v and the friction impulse at equal tau.
  T ErrorOfU() const {
    const Matrix<T>& w = problem_.w;
    return kSafety * Size(sum_.known.Velocity1(w), sum_.known.Velocity2(w)) + RestOfU();
  }
  T RestOfU() const {
    const Matrix<T>& w = problem_.w;
    return Size(sum_.doubtful.Velocity1(w), sum_.doubtful.Velocity2(w)) +
           problem_.largest_root * (sum_.friction + sum_.slip_rounding) + u_rounding_ + DoubtOfU();
  }
  T ErrorOfF(const Path<T>& path) const {
    if (problem_.HasNoFriction()) return T{0};
    const T most = problem_.keeps_part > T{0} ? kInfinity<T> : T{2} * sum_.slip_rounding / problem_.smallest_root;
    const T strayed = std::min(problem_.mu * sum_.strayed, most);
    return kSafetyOfImpulses * Size(sum_.known.f1, sum_.known.f2) + Size(sum_.doubtful.f1, sum_.doubtful.f2) +
           sum_.friction / problem_.smallest_root + strayed + f_rounding_ + T{4} * kEpsilon<T> * MostFriction(path);
  }
  // The error of the change of energy in compression or of the whole impact that errors of the impulses at its end
  // make.
  T ErrorOfEnergy(const State<T>& at, T f, T tau, T u_error, T v_error) const {
    return (at.Slip() + u_error) * f + problem_.graze * (std::fabs(at.v) + v_error) * tau;
  }
  // The change of energy is that of impulses and velocities. Where slip stops, u is set to 0, and the friction impulse
  // has what u lacks; from there on the normal impulse has what v lacks.
  T EnergyRoundingOfStop(const Slopes<T>& slopes) const {
    if (f_rounding_ == T{0}) return T{0};
    const T tau = ImpulseErrorOfVelocityEvent(sum_.v_rounding, slopes);
    return T{0.5} *
           (problem_.velocity * (f_rounding_ + problem_.mu_static * tau) + problem_.graze * problem_.approach * tau);
  }
  static T Size(T x, T y) { return std::sqrt(x * x + y * y); }
  // The difference of the paths on both sides of a goal at which the contact is nearly at rest, in v and in u: the norm
  // of Wtt^-1 never grows. It does not count where the contact is locked, because both paths end at rest.
  T DoubtOfV() const {
    return locks_ ? T{0} : (T{1} + problem_.normal_root / problem_.smallest_root) * doubtful_velocity_;
  }
  T DoubtOfU() const { return locks_ ? T{0} : problem_.largest_root / problem_.smallest_root * doubtful_velocity_; }
  // The error of a contact that is locked during restitution: that of a true path that ends before the lock. It does so
  // with the velocities that its energy allows from where it came to be in doubt, or, if Poisson's impulse is spent
  // just before the lock, with what the slopes of slip give over the error of that impulse.
  T EstimateOfLock() const {
    const T growth = (T{1} + problem_.mu_static) * problem_.largest_root / problem_.smallest_root;
    const T spent =
        problem_.law == RestitutionLaw::kPoisson ? (T{1} + problem_.coefficient) * compression_.impulse : T{0};
    return growth * doubtful_velocity_ + spent * std::max(problem_.rate, problem_.steepest);
  }

  const ScaledProblem<T>& problem_;
  // The scaled errors so far.
  StepErrors<T> sum_;
  Compression known_compression_, compression_;
  T u_rounding_{0};
  T f_rounding_{0};  // of the friction impulse, where slip stops
  EndErrors<T> at_compression_end_;
  T compression_end_tau_{0};
  T event_distance_{0};
  T compression_end_v_{0};      // the v found in place of 0
  T stop_tau_ = -kInfinity<T>;  // where slip stopped, from the start of the phase
  T holding_{0};                // the friction that holds the contact, for each unit of normal impulse
  T settles_{0};                // the normal impulse after which the true path sticks as well
  bool in_doubt_ = false;       // Whether the path passes a goal that it came near to, while it was not nearly at rest.
  T doubtful_velocity_{0};      // The largest velocity at which it came near to a goal.
  bool locks_ = false;
  Slopes<T> slip_slopes_ = {T{0}, T{0}, T{0}};
};

template <typename T>
void ErrorLedger<T>::AddStraightSlip(const Direction<T>& e, T length, T slip, T next_slip, T v) {
  sum_.Carry(problem_, {.length = length, .m = e, .first_slip = slip, .last_slip = next_slip});
  u_rounding_ += kEpsilon<T> * (problem_.rate * length * problem_.graze + T{0.5} * slip);
  sum_.Stray(problem_, length, std::min(slip, next_slip));
  sum_.AddRounding(problem_, T{2} * problem_.steepest * length, v, length);
}

// The true path sticks a little later, and is off by no more than before until then.
template <typename T>
void ErrorLedger<T>::AddStick(T length, T v) {
  const T unsettled = std::min(length, settles_);
  sum_.work += problem_.normal_root * (sum_.friction + sum_.slip_rounding) * unsettled;
  if (!(settles_ > length)) ForgetSlip();
  settles_ -= unsettled;
  sum_.v_rounding += kEpsilon<T> * (T{2} * problem_.w.w33 * length + T{0.5} * std::fabs(v));
  sum_.work += sum_.v_rounding * length;
}

template <typename T>
void ErrorLedger<T>::Stick(const Sticking<T>& sticking) {
  holding_ = Size(sticking.f1, sticking.f2);
  const T margin = problem_.mu - holding_;
  const T error = sum_.friction + sum_.slip_rounding;
  settles_ = error == T{0} ? T{0} : margin > T{0} ? error / (problem_.smallest_root * margin) : kInfinity<T>;
  locks_ = problem_.Locks(sticking);
  // The friction impulse that stops slip follows from the u that is lost, and so has the rounding of u.
  const T root = problem_.smallest_root;
  if (error > T{0}) f_rounding_ += (sum_.slip_rounding + u_rounding_ / root) / root;
  if (locks_) return ForgetSlip();
  // A stop at the wrong impulse leaves in v the difference of the two slopes times the error of that impulse.
  const Slopes<T>& before = slip_slopes_;
  const T slowing = Size(before.u1, before.u2);
  if (slowing > T{0}) sum_.v_rounding += std::fabs(before.v - sticking.v_slope) * (u_rounding_ / slowing);
  u_rounding_ = T{0};
}

template <typename T>
void ErrorLedger<T>::EndCompression(const Path<T>& path, const Slopes<T>& slopes) {
  const T doubtful = std::fabs(sum_.doubtful.NormalVelocity(problem_.w)) + DoubtOfV();
  compression_ = {.impulse = ImpulseErrorOfVelocityEvent(VelocityError() + doubtful, slopes) + event_distance_,
                  .work = sum_.work + std::fabs(sum_.doubtful.work) + WorkRounding(path)};
  known_compression_ = {.impulse = ImpulseErrorOfVelocityEvent(sum_.known.NormalVelocity(problem_.w), slopes),
                        .work = sum_.known.work};
  const T v_error =
      VelocityError() + kSafety * std::fabs(sum_.known.NormalVelocity(problem_.w)) + doubtful + std::fabs(path.state.v);
  EndErrors<T>& at = at_compression_end_;
  at.tau_compression = compression_.impulse + kSafetyOfImpulses * std::fabs(known_compression_.impulse) +
                       T{2} * kEpsilon<T> * path.state.tau;
  at.f = ErrorOfF(path) + FrictionRatio(path) * at.tau_compression;
  // The work is the integral of v, whose errors may be larger on the way than they are at the end.
  at.normal_compression = compression_.work + kSafetyOfImpulses * std::fabs(known_compression_.work) +
                          v_error * (at.tau_compression + kOfParts * path.state.tau);
  at.energy = ErrorOfEnergy(path.state, at.f, at.tau_compression,
                            ErrorOfU() + problem_.graze * Size(slopes.u1, slopes.u2) * at.tau_compression, v_error);
  at.tangential_compression =
      at.energy + problem_.graze * at.normal_compression + T{4} * kEpsilon<T> * std::fabs(path.state.friction_work);
  if (path.IsRounding(path.state.v)) sum_.v_rounding += std::fabs(path.state.v);  // v is set to 0.
  compression_end_tau_ = path.state.tau;
  compression_end_v_ = path.state.v;
  event_distance_ = sum_.work = sum_.known.work = sum_.doubtful.work = T{0};
  stop_tau_ -= path.state.tau;
}

template <typename T>
T ErrorLedger<T>::ImpulseErrorOfEnd(const Path<T>& path, const Slopes<T>& slopes, T velocity_error, T work_error,
                                    const Compression& compression) const {
  const T coefficient = problem_.coefficient;
  if (path.regime == Regime::kLocked) return T{0};  // At rest it does not matter which impulse has led there.
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
T ErrorLedger<T>::GoalError(const Path<T>& path, Quantity quantity) const {
  const Matrix<T>& w = problem_.w;
  switch (quantity) {
    case Quantity::kVelocity:
      return VelocityError() + kSafety * std::fabs(sum_.known.NormalVelocity(w)) +
             std::fabs(sum_.doubtful.NormalVelocity(w));
    case Quantity::kImpulse:
      return T{0};
    case Quantity::kWork:
      break;
  }
  return sum_.work + kSafety * std::fabs(sum_.known.work) + std::fabs(sum_.doubtful.work) + WorkRounding(path);
}

template <typename T>
EndErrors<T> ErrorLedger<T>::AtEnd(const Path<T>& path, const Slopes<T>& slopes) const {
  constexpr T kOutput = T{1.5} * kEpsilon<T>;
  EndErrors<T> unknown = at_compression_end_;
  for (T* error : {&unknown.relative, &unknown.u, &unknown.v, &unknown.tau, &unknown.f, &unknown.normal_restitution,
                   &unknown.tangential_restitution, &unknown.energy}) {
    *error = kInfinity<T>;
  }
  if (locks_) {
    for (T* error : {&unknown.tau_compression, &unknown.normal_compression, &unknown.tangential_compression}) {
      *error = kInfinity<T>;
    }
  }
  if (locks_ && !in_doubt_ && path.regime != Regime::kLocked) {
    unknown.u = unknown.v = EstimateOfLock();
    unknown.relative = unknown.u / problem_.velocity + kOutput;
    return unknown;
  }
  // Restitution that has to give back work ends with v > 0, if the work of compression is known at all.
  const bool lost_work =
      problem_.coefficient > T{0} && path.goal.quantity == Quantity::kWork && !path.Sticks() && !(path.state.v > T{0});
  // If friction locks the contact, slip and v vanish together, so that every path to the lock comes near to its goal.
  const bool in_doubt = in_doubt_ && path.regime != Regime::kLocked;
  if (in_doubt || lost_work) return unknown;
  const Matrix<T>& w = problem_.w;
  // Poisson's impulse may have been used up at a v of uncertain sign.
  const bool v_is_turned = problem_.law == RestitutionLaw::kPoisson && path.goal.quantity == Quantity::kVelocity;
  const T v_found =
      v_is_turned ? std::fabs(compression_end_v_) + kSafety * std::fabs(sum_.known.NormalVelocity(w)) : T{0};
  const T v_error_of_state = VelocityError() + std::fabs(sum_.doubtful.NormalVelocity(w)) + v_found + DoubtOfV();
  const T jump = compression_end_v_ * compression_end_v_ / std::max(slopes.v, kEpsilon<T>);
  T impulse = ImpulseErrorOfEnd(
                  path, slopes, v_error_of_state,
                  sum_.work + std::fabs(sum_.doubtful.work) + WorkRounding(path) + jump + DoubtOfV() * path.state.tau,
                  compression_) +
              event_distance_;
  const T known_impulse = SignedImpulseErrorOfEnd(path, slopes, sum_.known, known_compression_);
  const T all = impulse + kSafety * std::fabs(known_impulse);
  T u_slope = Size(slopes.u1, slopes.u2);
  T v_slope = std::fabs(slopes.v);
  if (path.state.tau - stop_tau_ <= T{2} * all) {  // The impact may end before slip stops.
    impulse = all;
    u_slope = std::max(u_slope, Size(slip_slopes_.u1, slip_slopes_.u2));
    v_slope = std::max(v_slope, std::fabs(slip_slopes_.v));
  }
  const T known_u =
      Size(sum_.known.Velocity1(w) + slopes.u1 * known_impulse, sum_.known.Velocity2(w) + slopes.u2 * known_impulse);
  const T known_v = std::fabs(sum_.known.NormalVelocity(w) + slopes.v * known_impulse);
  EndErrors<T> errors = at_compression_end_;
  errors.u = kSafety * known_u + RestOfU() + problem_.graze * impulse * u_slope;
  // A v that ends the impact has its error from root finding alone. Where friction locks the contact, v ends nothing.
  const bool v_is_goal = path.regime != Regime::kLocked &&
                         (problem_.coefficient == T{0} || (path.goal.quantity == Quantity::kVelocity && !v_is_turned));
  errors.v = v_is_goal ? event_distance_ * v_slope : kSafety * known_v + v_error_of_state + impulse * v_slope;
  // Compression may have ended beyond a small velocity that Newton's law asks for.
  if (v_is_goal && problem_.coefficient > T{0}) {
    errors.v = std::max(errors.v, T{1.5} * std::fabs(path.state.v - path.goal.target));
  }
  errors.relative = std::max(errors.u, problem_.graze * errors.v) / problem_.velocity + kOutput;
  // Each velocity by itself has no other one whose error is larger: what cancels in the known errors counts in part.
  errors.u += kOfParts * (Size(sum_.known.Velocity1(w), sum_.known.Velocity2(w)) +
                          problem_.graze * u_slope * std::fabs(known_impulse));
  if (!v_is_goal) {
    errors.v += kOfParts * (std::fabs(sum_.known.NormalVelocity(w)) + v_slope * std::fabs(known_impulse));
  }
  if (locks_) {
    unknown.u = errors.u;
    unknown.v = errors.v;
    unknown.relative = errors.relative;
    return unknown;
  }
  const T of_stop = EnergyRoundingOfStop(slopes);
  if (problem_.coefficient == T{0}) {
    errors.tau = errors.tau_compression;
    errors.normal_restitution = errors.tangential_restitution = T{0};
    // The change of energy is that of impulses and velocities, of which v is set to 0.
    errors.energy += T{0.5} * problem_.graze * std::fabs(compression_end_v_) * compression_end_tau_ + of_stop;
    return errors;
  }
  errors.tau = impulse + kSafetyOfImpulses * std::fabs(known_impulse) +
               T{2} * kEpsilon<T> * (compression_end_tau_ + path.state.tau);
  // Restitution does not end before compression does, which counts where it is shorter than that end is uncertain.
  constexpr T kShort{8};
  if (path.state.tau <= kShort * errors.tau_compression) {
    errors.tau = std::max(errors.tau, errors.tau_compression + path.state.tau);
  }
  errors.f = ErrorOfF(path) + FrictionRatio(path) * errors.tau;
  // Restitution that ends at a stated work has the error of that work and of root finding.
  const T stated = problem_.coefficient * problem_.coefficient * errors.normal_compression +
                   std::fabs(path.state.v) * event_distance_ + WorkRounding(path);
  const T followed = GoalError(path, Quantity::kWork) + v_error_of_state * (path.state.tau + all) +
                     (std::fabs(path.state.v) + v_slope * all) * (all + errors.tau_compression);
  errors.normal_restitution = path.goal.quantity == Quantity::kWork ? stated + jump : followed + jump;
  const T energy = ErrorOfEnergy(path.state, errors.f, all, errors.u, errors.v + v_slope * all);
  errors.tangential_restitution = energy + errors.energy + problem_.graze * errors.normal_restitution +
                                  T{4} * kEpsilon<T> * std::fabs(path.state.friction_work);
  errors.energy = energy + of_stop;
  return errors;
}

}  // namespace ricochet::spatial::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
