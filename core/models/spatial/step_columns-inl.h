// StepColumns: the numbers that a step reads and writes, column by column, with one entry for each SIMD lane.

// Per-target include guard.
#if defined(RICOCHET_CORE_MODELS_SPATIAL_STEP_COLUMNS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef RICOCHET_CORE_MODELS_SPATIAL_STEP_COLUMNS_INL_H_
#undef RICOCHET_CORE_MODELS_SPATIAL_STEP_COLUMNS_INL_H_
#else
#define RICOCHET_CORE_MODELS_SPATIAL_STEP_COLUMNS_INL_H_
#endif

#include <array>
#include <cstddef>
#include <limits>

#include "core/models/spatial/path-inl.h"
#include "core/models/spatial/problem-inl.h"
#include "core/models/spatial/solver-inl.h"
#include "core/models/spatial/step-inl.h"

#if RICOCHET_SIMD
HWY_BEFORE_NAMESPACE();
namespace ricochet::spatial::HWY_NAMESPACE {

inline constexpr size_t kLanes = hwy::HWY_NAMESPACE::MaxLanes(hwy::HWY_NAMESPACE::ScalableTag<double>());

// One number for each lane. A truth value is 1 or 0.
struct alignas(kLanes * sizeof(double)) Column {
  std::array<double, kLanes> of = {};

  Column() = default;
  explicit Column(double number) { of.fill(number); }
  HWY_INLINE void LoadTo(LaneNumber& numbers) const {
    numbers = LaneNumber(hwy::HWY_NAMESPACE::Load(Tag(), of.data()));
  }
  HWY_INLINE void LoadTo(MaskOf<LaneNumber>& mask) const {
    LaneNumber numbers;
    LoadTo(numbers);
    mask = LaneNumber{0} < numbers;
  }
  HWY_INLINE void Store(LaneNumber numbers) { hwy::HWY_NAMESPACE::Store(numbers.value, Tag(), of.data()); }
  HWY_INLINE void Store(MaskOf<LaneNumber> mask) { Store(Select(mask, LaneNumber{1}, LaneNumber{0})); }

  // A column of truth values is a column, too (MaskOf).
  friend Column operator<(const Column&, const Column&);

 private:
  using Tag = hwy::HWY_NAMESPACE::ScalableTag<double>;
};

// Each of these calls `f` with the numbers of `a` and the same numbers of `b`, of which one holds columns.
template <typename A, typename B, typename F>
HWY_INLINE void EachOfContact(A& a, B& b, const F& f) {
  f(a.w.w11, b.w.w11);
  f(a.w.w12, b.w.w12);
  f(a.w.w13, b.w.w13);
  f(a.w.w22, b.w.w22);
  f(a.w.w23, b.w.w23);
  f(a.w.w33, b.w.w33);
  f(a.mu, b.mu);
  f(a.velocity, b.velocity);
  f(a.approach, b.approach);
  f(a.rate, b.rate);
  f(a.largest_root, b.largest_root);
  f(a.smallest_root, b.smallest_root);
  f(a.keeps_part, b.keeps_part);
  f(a.normal_root, b.normal_root);
  f(a.steepest, b.steepest);
}

template <typename A, typename B, typename F>
HWY_INLINE void EachOfState(A& a, B& b, const F& f) {
  f(a.tau, b.tau);
  f(a.f1, b.f1);
  f(a.f2, b.f2);
  f(a.u1, b.u1);
  f(a.u2, b.u2);
  f(a.v, b.v);
  f(a.friction_work, b.friction_work);
  f(a.normal_work, b.normal_work);
}

template <typename A, typename B, typename F>
HWY_INLINE void EachOfGoal(A& a, B& b, const F& f) {
  EachOfState(a.from, b.from, f);
  f(a.target, b.target);
  f(a.to_velocity, b.to_velocity);
  f(a.to_impulse, b.to_impulse);
  f(a.may_turn, b.may_turn);
  f(a.in_restitution, b.in_restitution);
}

template <typename A, typename B, typename F>
HWY_INLINE void EachOfErrors(A& a, B& b, const F& f) {
  f(a.known.f1, b.known.f1);
  f(a.known.f2, b.known.f2);
  f(a.known.work, b.known.work);
  f(a.doubtful.f1, b.doubtful.f1);
  f(a.doubtful.f2, b.doubtful.f2);
  f(a.doubtful.work, b.doubtful.work);
  f(a.friction, b.friction);
  f(a.slip_rounding, b.slip_rounding);
  f(a.strayed, b.strayed);
  f(a.v_rounding, b.v_rounding);
  f(a.work, b.work);
}

class StepColumns {
 public:
  // Sets a lane to an impact whose first step is to be taken.
  void Set(size_t lane, const Solver<double>& solver);
  // Sets a lane to another place on the path of the same impact.
  void SetPath(size_t lane, const Solver<double>& solver);
  // Leaves a lane without an impact: its state is NaN, so that it never reaches a goal.
  void SetIdle(size_t lane);

  // Takes the steps of all lanes. Each lane is then set to its next step, unless it needs attention.
  void Take(int order);

  // True if something other than another step may follow, or if every step is to be accepted.
  bool NeedsAttention(size_t lane) const {
    return pauses_.of[lane] != 0.0 || reaches_goal_.of[lane] != 0.0 || goal_.may_turn.of[lane] != 0.0;
  }
  // The end of a lane's step.
  StepEnd<double> EndOf(size_t lane) const;
  // True if the impact would do something other than to take another step, also if it has not ended its phase.
  bool Pauses(size_t lane) const { return pauses_.of[lane] != 0.0; }

 private:
  static auto SetAt(size_t lane) {
    return [lane](Column& column, auto number) { column.of[lane] = static_cast<double>(number); };
  }
  static auto GetAt(size_t lane) {
    return [lane](const Column& column, double& number) { number = column.of[lane]; };
  }

  // The impact and its phase. The path is at `goal_.from`, the end of the last step.
  Contact<Column> contact_;
  Column tolerance_, stopped_;
  PhaseGoal<Column> goal_;
  StepErrors<Column> errors_;

  // The rest of what is known of the last step.
  Direction<Column> e_;
  Column overshoot_, reaches_goal_, distance_to_goal_, pauses_;
};

inline void StepColumns::Set(size_t lane, const Solver<double>& solver) {
  const auto set = SetAt(lane);
  EachOfContact(contact_, solver.problem(), set);
  set(tolerance_, solver.tolerance());
  set(stopped_, solver.StoppedSlip());
  SetPath(lane, solver);
}

inline void StepColumns::SetPath(size_t lane, const Solver<double>& solver) {
  const PhaseGoal<double> goal = solver.path().GoalFromHere();
  EachOfGoal(goal_, goal, SetAt(lane));
  EachOfErrors(errors_, solver.errors(), SetAt(lane));
}

inline void StepColumns::SetIdle(size_t lane) {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  goal_.may_turn.of[lane] = 0.0;
  for (Column* column : {&goal_.from.u1, &goal_.from.u2, &goal_.from.v, &goal_.target}) column->of[lane] = kNone;
}

inline void StepColumns::Take(int order) {
  const auto load = [](const Column& column, auto& numbers) HWY_ATTR { column.LoadTo(numbers); };
  const auto store = [](Column& column, const auto& numbers) HWY_ATTR { column.Store(numbers); };
  Contact<LaneNumber> contact;
  PhaseGoal<LaneNumber> goal = {};
  StepErrors<LaneNumber> errors = {};
  LaneNumber tolerance, stopped;
  EachOfContact(contact_, contact, load);
  EachOfGoal(goal_, goal, load);
  EachOfErrors(errors_, errors, load);
  load(tolerance_, tolerance);
  const StepEnd<LaneNumber> end =
      TakeStep(contact, goal, errors, SlipFrame<LaneNumber>(contact, goal.from), tolerance, order);
  EachOfState(goal_.from, end.state, store);
  EachOfErrors(errors_, end.errors, store);
  store(e_.c, end.e.c);
  store(e_.s, end.e.s);
  store(overshoot_, end.overshoot);
  store(reaches_goal_, end.reaches_goal);
  store(distance_to_goal_, end.distance_to_goal);
  load(stopped_, stopped);
  store(pauses_, Solver<double>::Pauses(SlipFrame<LaneNumber>(contact, end.state), stopped, tolerance));
}

inline StepEnd<double> StepColumns::EndOf(size_t lane) const {
  StepEnd<double> end = {.state = {},
                         .e = {e_.c.of[lane], e_.s.of[lane]},
                         .errors = {},
                         .overshoot = overshoot_.of[lane],
                         .reaches_goal = reaches_goal_.of[lane] != 0.0,
                         .distance_to_goal = distance_to_goal_.of[lane]};
  EachOfState(goal_.from, end.state, GetAt(lane));
  EachOfErrors(errors_, end.errors, GetAt(lane));
  return end;
}

}  // namespace ricochet::spatial::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // RICOCHET_SIMD

#endif  // per-target include guard
