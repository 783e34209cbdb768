// Parts of a path are straight in tau: slip that keeps its direction, a contact that sticks, and one without friction.
// They have no error but rounding.

// Per-target include guard.
#if defined(RICOCHET_CORE_MODELS_SPATIAL_STRAIGHT_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef RICOCHET_CORE_MODELS_SPATIAL_STRAIGHT_INL_H_
#undef RICOCHET_CORE_MODELS_SPATIAL_STRAIGHT_INL_H_
#else
#define RICOCHET_CORE_MODELS_SPATIAL_STRAIGHT_INL_H_
#endif

#include <algorithm>
#include <utility>

#include "core/models/spatial/matrix-inl.h"
#include "core/models/spatial/path-inl.h"
#include "core/models/spatial/problem-inl.h"
#include "core/models/spatial/progress-inl.h"

HWY_BEFORE_NAMESPACE();
namespace ricochet::spatial::HWY_NAMESPACE {

// A part of the path with constant slopes.
enum class Motion { kSlips, kSticks, kIsFree };
template <typename T>
struct StraightPiece {
  Motion motion;
  Slopes<T> slopes;
  Direction<T> e;            // of slip
  T f1, f2;                  // df/dtau
  T length;                  // the normal impulse after which slip stops
  bool ends_locked = false;  // The body will be locked where slip stops, and no event comes before.
};

namespace internal {

// The state after a part of a piece, with the friction work of the state before.
template <typename T>
State<T> StateAfter(const StraightPiece<T>& piece, T length, const State<T>& before) {
  State<T> state = before;
  state.tau += length;
  state.f1 += piece.f1 * length;
  state.f2 += piece.f2 * length;
  state.u1 += piece.slopes.u1 * length;
  state.u2 += piece.slopes.u2 * length;
  state.v += piece.slopes.v * length;
  state.normal_work += T{0.5} * length * (before.v + state.v);
  return state;
}

template <typename T>
void Advance(Progress<T>& impact, const StraightPiece<T>& piece, T length) {
  State<T>& state = impact.path.state;
  const T slip = state.Slip();
  const State<T> before = std::exchange(state, StateAfter(piece, length, state));
  if (impact.path.RecedesSince(before)) {
    const bool passes_zero = impact.path.goal.quantity == Quantity::kWork && before.v > T{0};
    impact.path.RecordReceding(StateAfter(piece, passes_zero ? -before.v / piece.slopes.v : T{0}, before));
  }
  switch (piece.motion) {
    case Motion::kSlips: {
      const T next_slip = state.Slip();
      state.friction_work -= impact.problem.mu * length * T{0.5} * (slip + next_slip);
      return impact.errors.AddStraightSlip(piece.e, length, slip, next_slip, state.v);
    }
    case Motion::kSticks:
      return impact.errors.AddStick(length, state.v);
    case Motion::kIsFree:
      state.friction_work += length * (piece.f1 * state.u1 + piece.f2 * state.u2);
      return impact.errors.AddFree(length, state.v);
  }
}

// Follows a piece through the ends of phases on it, to its own end or that of the impact.
template <typename T>
void Follow(Progress<T>& impact, const StraightPiece<T>& piece) {
  T left = piece.length;
  while (!impact.path.ended) {
    const T to_goal = piece.ends_locked ? kInfinity<T> : impact.path.GoalFromHere().ImpulseToGoal(piece.slopes);
    const T length = std::min(to_goal, left);
    if (!(length < kInfinity<T>)) {
      if (impact.path.IsAtVelocityGoal()) impact.EndPhase(piece.slopes);
      return;
    }
    Advance(impact, piece, length);
    if (!(to_goal <= left)) return;
    left -= length;
    impact.EndPhase(piece.slopes);
  }
}

// If friction and the joints would lock the body, slip whose growth is at most rounding counts as standing still:
// friction then needs all of its cone to hold it, and v stands still, too.
template <typename T>
constexpr T kStandingGrowth = T{16} * kEpsilon<T>;

// Follows slip along e until it stops or the impact ends. Returns false if neither comes to pass.
template <typename T>
bool FollowSlip(Progress<T>& impact, const Direction<T>& e) {
  const ScaledProblem<T>& problem = impact.problem;
  const Slopes<T> slopes = problem.SlopesAlong(e);
  const T slip = impact.path.state.Slip();
  T growth = slopes.u1 * e.c + slopes.u2 * e.s;
  // Slip that starts grows, however slowly: rounded to below 0, the growth would stop it where it is.
  if (slip == T{0}) growth = std::max(growth, T{0});
  impact.errors.AddSlipRounding(slip);
  StraightPiece<T> piece = {.motion = problem.mu > T{0} ? Motion::kSlips : Motion::kIsFree,
                            .slopes = {problem.graze * growth * e.c, problem.graze * growth * e.s, slopes.v},
                            .e = e,
                            .f1 = -problem.mu * e.c,
                            .f2 = -problem.mu * e.s,
                            .length = growth < T{0} && !problem.grazes ? -slip / growth : kInfinity<T>};
  if (problem.w.rank < 3) {
    const Sticking<T> sticking = problem.w.Stick(problem.mu_static);
    const bool locks = sticking.holds && problem.Locks(sticking);
    if (locks && std::fabs(growth) <= kStandingGrowth<T> * problem.rate) {
      piece.slopes = {T{0}, T{0}, T{0}};
      piece.length = kInfinity<T>;
    }
    // Where friction and the joints will lock the body, v vanishes with u, and rounding must not let it come first.
    piece.ends_locked = locks && !impact.path.in_restitution && piece.length < kInfinity<T>;
  }
  impact.errors.SetSlopesOfSlip(piece.slopes);
  Follow(impact, piece);
  return impact.path.ended || piece.length < kInfinity<T>;
}

// Ends the impact at rest: no further impulse can move the body.
template <typename T>
void EndLocked(Progress<T>& impact) {
  impact.path.SetRegime(Regime::kLocked, Regime::kStickInRestitution);
  const Slopes<T> none = {T{0}, T{0}, T{0}};
  impact.path.state.v = T{0};
  impact.path.stops_short = impact.path.in_restitution;
  if (!impact.path.in_restitution) impact.EndCompression(none);
  if (!impact.path.ended) impact.EndImpact(none);
}

template <typename T>
void FollowStick(Progress<T>& impact, const Sticking<T>& sticking) {
  impact.errors.Stick(sticking);
  if (impact.problem.Locks(sticking)) return EndLocked(impact);
  impact.path.SetRegime(Regime::kStickInCompression, Regime::kStickInRestitution);
  Follow<T>(impact, {.motion = Motion::kSticks,
                     .slopes = {T{0}, T{0}, sticking.v_slope},
                     .e = {T{0}, T{0}},
                     .f1 = sticking.f1,
                     .f2 = sticking.f2,
                     .length = kInfinity<T>});
}

}  // namespace internal

// Continues where slip is 0: the contact sticks, or slips in the direction in which slip grows. Slip that grows stops
// again only where numbers leave the range of doubles; the path then stays there and has not ended.
template <typename T>
void ContinueFromStop(Progress<T>& impact) {
  Path<T>& path = impact.path;
  impact.errors.StopSlip(path.state.tau);
  path.state.u1 = path.state.u2 = T{0};
  const bool at_start = path.IsAtStart();
  if (!at_start) path.Record(EventKind::kSlipStops);
  const Sticking<T> sticking = impact.problem.w.Stick(impact.problem.mu_static);
  if (sticking.holds) return internal::FollowStick(impact, sticking);
  if (!at_start) path.SetRegime(Regime::kReversalInCompression, Regime::kReversalInRestitution);
  internal::FollowSlip(impact, impact.problem.w.Restart(impact.problem.mu));
  if (!path.ended) path.state.u1 = path.state.u2 = T{0};
}

// Follows slip along e, which has the direction of slip and does not turn, and what comes after its stop.
template <typename T>
void SlideStraight(Progress<T>& impact, const Direction<T>& e) {
  const bool comes_to_an_end = internal::FollowSlip(impact, e);
  if (comes_to_an_end && !impact.path.ended) ContinueFromStop(impact);
}

// Follows slip along e that stands still, as it does where Wtt is singular and part of the slip is beyond the reach of
// any impulse: friction along the direction of Wtt balances wtn, as in a contact that sticks. Where v' = 0, too, and v
// < 0, the contact has jammed, and the path does not end.
template <typename T>
void SlideStanding(Progress<T>& impact, const Direction<T>& e) {
  const ScaledProblem<T>& problem = impact.problem;
  const Slopes<T> slopes = {T{0}, T{0}, problem.w.Stick(problem.mu_static).v_slope};
  impact.errors.AddSlipRounding(impact.path.state.Slip());
  impact.errors.SetSlopesOfSlip(slopes);
  internal::Follow<T>(impact, {.motion = Motion::kSlips,
                               .slopes = slopes,
                               .e = e,
                               .f1 = -problem.mu * e.c,
                               .f2 = -problem.mu * e.s,
                               .length = kInfinity<T>});
}

// Follows a contact whose slip no friction changes. It may stick if its slip happens to vanish.
template <typename T>
void SlideFreely(Progress<T>& impact) {
  const Matrix<T>& w = impact.problem.w;
  const State<T>& state = impact.path.state;
  const T graze = impact.problem.graze;
  const T cross = state.u1 * w.w23 - state.u2 * w.w13;
  const T along = state.u1 * w.w13 + state.u2 * w.w23;
  if (cross == T{0} && along < T{0}) return SlideStraight(impact, Normalized(state.u1, state.u2));
  const T slip = state.Slip();
  const T friction = slip > T{0} ? impact.problem.mu / slip : T{0};
  internal::Follow<T>(impact, {.motion = Motion::kIsFree,
                               .slopes = {graze * w.w13, graze * w.w23, w.w33},
                               .e = {T{0}, T{0}},
                               .f1 = -friction * state.u1,
                               .f2 = -friction * state.u2,
                               .length = kInfinity<T>});
}

}  // namespace ricochet::spatial::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
