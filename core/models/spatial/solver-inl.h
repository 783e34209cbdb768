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

#include <algorithm>
#include <cmath>
#include <cstdint>

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
  Impact Run();

 private:
  // The budget lies far above the number of steps of every impact that tests have found.
  static constexpr int64_t kStepBudget = 10000;
  // Shares of the tolerance: for the last terms of a step, and for leaving a curve for its asymptote.
  static constexpr T kStepShare{0.175};
  static constexpr T kSwitchShare{0.2};

  static int OrderFor(T tolerance);
  bool SlipKeepsItsDirection() const;
  void FollowCurve();
  void TakeStep(const Frame<T>& frame, T slip);
  bool SwitchToStraight(const Frame<T>& frame, T slip);
  void TurnSlipTo(const Direction<T>& e);

  const T tolerance_;
  const int order_;
  Progress<T> impact_;
  const ScaledProblem<T>& problem_ = impact_.problem;
  State<T>& state_ = impact_.path.state;
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
Impact Solver<T>::Run() {
  const bool slips = state_.u1 != T{0} || state_.u2 != T{0};
  bool closed_form = true;
  if (problem_.w.HasNoTangentialMobility() || (slips && problem_.mu == T{0})) {
    SlideFreely(impact_);
  } else if (!slips) {
    ContinueFromStop(impact_);
  } else if (SlipKeepsItsDirection()) {
    SlideStraight(impact_, Normalized(state_.u1, state_.u2));
  } else {
    closed_form = false;
    FollowCurve();
  }
  Impact impact = MakeImpact(problem_, impact_.path, impact_.estimate);
  if (!impact_.path.ended && steps_ >= kStepBudget) impact.termination = Termination::kBudgetUsedUp;
  impact.closed_form = closed_form;
  impact.steps = steps_;
  impact.right_hand_sides = steps_ * order_;
  return impact;
}

template <typename T>
bool Solver<T>::SlipKeepsItsDirection() const {
  constexpr T kInvariant = T{8} * kEpsilon<T>;
  return problem_.w.tangent_is_singular ||
         std::fabs(problem_.FrameAt(Normalized(state_.u1, state_.u2)).Turn()) <= kInvariant;
}

template <typename T>
void Solver<T>::FollowCurve() {
  // Slip below this size has stopped as far as velocities go. Where static friction exceeds kinetic friction, the
  // threshold is lower, because a near miss must not stick.
  const T stopped = problem_.mu_static > problem_.mu ? T{0x1p-400} : T{0x1p-70};
  while (!impact_.path.ended && steps_ < kStepBudget) {
    const T slip = state_.Slip();
    if (slip < stopped) {
      if (slip > T{0}) impact_.errors.SetSlopesOfSlip(problem_.SlopesAlong(Normalized(state_.u1, state_.u2)));
      return ContinueFromStop(impact_);
    }
    const Frame<T> frame = problem_.FrameAt({state_.u1 / slip, state_.u2 / slip});
    if (SwitchToStraight(frame, slip)) return;
    TakeStep(frame, slip);
  }
}

template <typename T>
void Solver<T>::TakeStep(const Frame<T>& frame, T slip) {
  const Path<T>& path = impact_.path;
  const Step<T> step(problem_, path, frame, slip, order_);
  ++steps_;
  T end = step.AccurateEnd(kStepShare * tolerance_ * problem_.velocity);
  if (problem_.may_jam) end = step.MonotonicEnd(end);
  State<T> next = step.At(end);
  const T beyond = path.Value(next) - path.goal.target;
  const bool reaches_goal = beyond >= T{0};
  if (reaches_goal) {
    end = step.GoalWithin(end, T{1e-2} * std::sqrt(tolerance_));
    next = step.At(end);
  }
  ErrorLedger<T>& errors = impact_.errors;
  const T next_slip = next.Slip();
  const Direction<T> next_e = {next.u1 / next_slip, next.u2 / next_slip};
  errors.AddStep(step.ErrorAt(end, next, next_e), next.tau - state_.tau, {frame.c, frame.s}, slip, next_e, next_slip,
                 next.v);
  state_ = next;
  if (problem_.may_jam) errors.NoteGap(path, std::fabs(beyond));
  if (!reaches_goal) return;
  const Rates<T> rates = path.GoalRates(next);
  errors.SetEventOffset(T{2} * std::fabs(rates.value / rates.slope) * next_slip / problem_.rate);
  impact_.EndPhase(problem_.SlopesAlong(next_e));
}

// Slip may be so near to a direction that attracts it that what it still turns by cannot be seen in the result. It then
// follows that direction, exactly linear in tau, until it stops or the impact ends.
template <typename T>
bool Solver<T>::SwitchToStraight(const Frame<T>& frame, T slip) {
  const T turn_slope = frame.TurnSlope();
  if (!(turn_slope < T{0})) return false;
  constexpr T kNear{0.1};
  if (!(std::fabs(frame.Turn()) <= -kNear * turn_slope)) return false;
  if (!(slip * std::fabs(frame.Turn() / turn_slope) <= kSwitchShare * tolerance_ * problem_.velocity)) return false;
  const auto attracting = problem_.AttractingDirectionNear(frame);
  if (!attracting.has_value()) return false;
  TurnSlipTo(*attracting);
  SlideStraight(impact_, *attracting);
  return true;
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
