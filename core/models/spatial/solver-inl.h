// The algorithm behind core/models/spatial/spatial.h over a floating type T: double, or a wider one in tests.
//
// Slip that turns is followed in steps of its Taylor series, until it stops, ends the impact, or comes so near to a
// direction that attracts it that it counts as straight from there.

// Per-target include guard.
#if defined(RICOCHET_CORE_MODELS_SPATIAL_SOLVER_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef RICOCHET_CORE_MODELS_SPATIAL_SOLVER_INL_H_
#undef RICOCHET_CORE_MODELS_SPATIAL_SOLVER_INL_H_
#else
#define RICOCHET_CORE_MODELS_SPATIAL_SOLVER_INL_H_
#endif

#include <cmath>
#include <cstdint>
#include <optional>
#include <utility>

#include "core/models/spatial/matrix-inl.h"
#include "core/models/spatial/path-inl.h"
#include "core/models/spatial/problem-inl.h"
#include "core/models/spatial/progress-inl.h"
#include "core/models/spatial/report-inl.h"
#include "core/models/spatial/spatial.h"
#include "core/models/spatial/step-inl.h"
#include "core/models/spatial/straight-inl.h"

HWY_BEFORE_NAMESPACE();
namespace ricochet::spatial::HWY_NAMESPACE {

// One impact, to be run once. `rank` is the rank of the problem's W.
template <typename T>
class Solver {
 public:
  Solver(const Problem& problem, int rank, T tolerance);

  Impact Run() {
    for (auto slip_frame = Start(); slip_frame.has_value(); slip_frame = GoOn()) {
      Accept(TakeStep<T>(problem_, impact_.path.GoalFromHere(), errors(), *slip_frame, tolerance_, order_), 1);
    }
    return Report();
  }

  // Run, step by step, for a caller who takes the steps himself. Start and GoOn follow what needs no step, and return
  // the frame of slip for the step that comes next, if there is one. Accept takes over the end of the last of some
  // steps, of which the others may not reach a goal or pause, and if dv/dtau < 0 is possible there must be no others.
  std::optional<SlipFrame<T>> Start();
  void Accept(const StepEnd<T>& end, int64_t steps);
  std::optional<SlipFrame<T>> GoOn();
  Impact Report() const;

  // The number of terms of each series.
  static int OrderFor(T tolerance);
  // True where GoOn would do more than return the frame of slip on a path that is under way.
  template <typename N>
  static HWY_INLINE MaskOf<N> Pauses(const SlipFrame<N>& slip_frame, N stopped, N tolerance) {
    return Either(slip_frame.slip < stopped, slip_frame.IsNearlyStraight(N{kSwitchShare} * tolerance));
  }
  bool IsUnderWay() const { return !impact_.path.ended && StepsLeft() > 0; }
  // The budget lies far above the number of steps of every impact that tests have found.
  int64_t StepsLeft() const { return kStepBudget - steps_; }
  // Slip below this size has stopped as far as velocities go. Where static friction exceeds kinetic friction, the
  // threshold is lower, because a near miss must not stick.
  T StoppedSlip() const { return problem_.mu_static > problem_.mu ? T{0x1p-400} : T{0x1p-70}; }
  const ScaledProblem<T>& problem() const { return problem_; }
  T tolerance() const { return tolerance_; }
  const Path<T>& path() const { return impact_.path; }
  const StepErrors<T>& errors() const { return impact_.errors.BeforeStep(); }

 private:
  static constexpr int64_t kStepBudget = 10000;
  // This share of the tolerance is left for replacing a curve by its asymptote.
  static constexpr double kSwitchShare = 0.2;

  bool SlipKeepsItsDirection() const;
  void SlideAlongTangent();
  bool SwitchToStraight(const SlipFrame<T>& slip_frame);
  bool StandsAlong(const Direction<T>& e) const;
  void StandSlipAlong(const Direction<T>& e);
  void TurnSlipTo(const Direction<T>& e);

  const T tolerance_;
  const int order_;
  Progress<T> impact_;
  const ScaledProblem<T>& problem_ = impact_.problem;
  State<T>& state_ = impact_.path.state;
  bool closed_form_ = true;
  int64_t steps_ = 0;
};

template <typename T>
Solver<T>::Solver(const Problem& problem, int rank, T tolerance)
    : tolerance_(tolerance), order_(OrderFor(tolerance)), impact_(problem, rank) {}

// The number of terms balances the cost of one more against how much longer a step it allows.
template <typename T>
int Solver<T>::OrderFor(T tolerance) {
  if (tolerance >= T{5e-4}) return 8;
  if (tolerance >= T{1e-5}) return 9;
  if (tolerance >= T{1e-7}) return 11;
  if (tolerance >= T{1e-9}) return 14;
  if (tolerance >= T{1e-11}) return 17;
  return tolerance >= T{1e-14} ? 20 : kMaxOrder;
}

template <typename T>
std::optional<SlipFrame<T>> Solver<T>::Start() {
  const bool slips = state_.u1 != T{0} || state_.u2 != T{0};
  if (problem_.w.HasNoTangentialMobility() || (slips && problem_.mu == T{0})) {
    SlideFreely(impact_);
  } else if (!slips) {
    ContinueFromStop(impact_);
  } else if (problem_.SlipHasOneDirection()) {
    SlideAlongTangent();
  } else if (SlipKeepsItsDirection()) {
    SlideStraight(impact_, Normalized(state_.u1, state_.u2));
  } else {
    closed_form_ = false;
    return GoOn();
  }
  return std::nullopt;
}

template <typename T>
Impact Solver<T>::Report() const {
  Impact impact = MakeImpact(problem_, impact_.path, impact_.end_errors);
  if (!impact_.path.ended && steps_ >= kStepBudget) impact.termination = Termination::kBudgetUsedUp;
  impact.closed_form = closed_form_;
  impact.steps = steps_;
  impact.right_hand_sides = steps_ * order_;
  return impact;
}

template <typename T>
bool Solver<T>::SlipKeepsItsDirection() const {
  constexpr T kInvariant = T{8} * kEpsilon<T>;
  return problem_.grazes || std::fabs(problem_.FrameAt(Normalized(state_.u1, state_.u2)).Turn()) <= kInvariant;
}

// Follows slip where Wtt is singular, so that slip can only have its direction d. A part of slip beside d is rounding
// alone; where the contact rolls, that part would have an arbitrary direction.
template <typename T>
void Solver<T>::SlideAlongTangent() {
  const Direction<T> d = problem_.w.TangentDirection();
  const T along = d.c * state_.u1 + d.s * state_.u2;
  state_.u1 = along * d.c;
  state_.u2 = along * d.s;
  if (along == T{0}) return ContinueFromStop(impact_);
  const T sign = std::copysign(T{1}, along);
  SlideStraight(impact_, {sign * d.c, sign * d.s});
}

template <typename T>
std::optional<SlipFrame<T>> Solver<T>::GoOn() {
  if (!IsUnderWay()) return std::nullopt;
  const SlipFrame<T> slip_frame(problem_, state_);
  if (!Pauses(slip_frame, StoppedSlip(), tolerance_)) return slip_frame;
  if (slip_frame.slip < StoppedSlip()) {
    if (slip_frame.slip > T{0}) impact_.errors.SetSlopesOfSlip(problem_.SlopesAlong(Normalized(state_.u1, state_.u2)));
    ContinueFromStop(impact_);
    return std::nullopt;
  }
  if (SwitchToStraight(slip_frame)) return std::nullopt;
  return slip_frame;
}

template <typename T>
void Solver<T>::Accept(const StepEnd<T>& end, int64_t steps) {
  steps_ += steps;
  if (problem_.may_jam) {
    // Steps end where v, or its slope, changes its sign.
    const State<T> before = std::exchange(state_, end.state);
    if (impact_.path.RecedesSince(before)) impact_.path.RecordReceding(before);
  } else {
    state_ = end.state;
  }
  impact_.errors.SetAfterStep(end.errors);
  if (problem_.may_jam) impact_.errors.NoteGap(impact_.path, std::fabs(end.overshoot));
  if (!end.reaches_goal) return;
  impact_.errors.SetEventDistance(end.distance_to_goal);
  Slopes<T> slopes = problem_.SlopesAlong(end.e);
  const Frame<T> frame = problem_.FrameAt(end.e);
  slopes.bend = problem_.mu * problem_.rate * problem_.rate * std::fabs(frame.w2 * frame.Turn()) / state_.Slip();
  impact_.EndPhase(slopes);
}

// Slip may be so near to a direction that attracts it that what it still turns by cannot be seen in the result. It then
// follows that direction, exactly linear in tau, until it stops or the impact ends.
template <typename T>
bool Solver<T>::SwitchToStraight(const SlipFrame<T>& slip_frame) {
  const auto attracting = problem_.AttractingDirectionNear(slip_frame.frame);
  if (!attracting.has_value()) return false;
  if (!problem_.w.tangent_is_singular) {
    TurnSlipTo(*attracting);
    SlideStraight(impact_, *attracting);
    return true;
  }
  // Slip that grows along the direction of Wtt keeps its part across it, and never stops turning.
  if (!StandsAlong(*attracting)) return false;
  StandSlipAlong(*attracting);
  SlideStanding(impact_, *attracting);
  return true;
}

// True if slip along e, which attracts its neighbours, keeps its size as well. Where Wtt is singular, slip is attracted
// by the direction of Wtt if it grows along it; otherwise it comes to stand.
template <typename T>
bool Solver<T>::StandsAlong(const Direction<T>& e) const {
  const Direction<T> d = problem_.w.TangentDirection();
  const T sign = std::copysign(T{1}, d.c * e.c + d.s * e.s);
  return problem_.FrameAt({sign * d.c, sign * d.s}).Growth() < T{0};
}

// Turns slip to the direction e, along which it stands, by an impulse along the direction d of Wtt. The part of slip
// across d is beyond the reach of any impulse.
template <typename T>
void Solver<T>::StandSlipAlong(const Direction<T>& e) {
  const Matrix<T>& w = problem_.w;
  const Direction<T> d = w.TangentDirection();
  const T across = d.c * state_.u2 - d.s * state_.u1;
  const T along = d.c * state_.u1 + d.s * state_.u2;
  const T change = across * (d.c * e.c + d.s * e.s) / (d.c * e.s - d.s * e.c) - along;
  const T df = change / (w.w11 + w.w22);
  impact_.errors.AddTurn(df * d.c, df * d.s);
  state_.friction_work += df * (along + T{0.5} * change);
  state_.f1 += df * d.c;
  state_.f2 += df * d.s;
  state_.u1 += change * d.c;
  state_.u2 += change * d.s;
  state_.v += (w.w13 * d.c + w.w23 * d.s) * df;
}

// Turns slip to the direction e by a friction impulse, so that the state remains one to which impulses lead.
template <typename T>
void Solver<T>::TurnSlipTo(const Direction<T>& e) {
  const Matrix<T>& w = problem_.w;
  const T slip = state_.Slip();
  const T du1 = slip * e.c - state_.u1;
  const T du2 = slip * e.s - state_.u2;
  const T determinant = w.TangentDeterminant();
  const T df1 = (w.w22 * du1 - w.w12 * du2) / determinant;
  const T df2 = (w.w11 * du2 - w.w12 * du1) / determinant;
  impact_.errors.AddTurn(df1, df2);
  state_.friction_work += df1 * (state_.u1 + T{0.5} * du1) + df2 * (state_.u2 + T{0.5} * du2);
  state_.f1 += df1;
  state_.f2 += df2;
  state_.u1 += du1;
  state_.u2 += du2;
  state_.v += w.w13 * df1 + w.w23 * df2;
}

}  // namespace ricochet::spatial::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
