// The path of an impact: the state reached, the phase it belongs to and the goal of that phase, the events so far.

// Per-target include guard.
#if defined(RICOCHET_CORE_MODELS_SPATIAL_PATH_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef RICOCHET_CORE_MODELS_SPATIAL_PATH_INL_H_
#undef RICOCHET_CORE_MODELS_SPATIAL_PATH_INL_H_
#else
#define RICOCHET_CORE_MODELS_SPATIAL_PATH_INL_H_
#endif

#include <array>
#include <cmath>
#include <cstddef>

#include "core/models/restitution_law.h"
#include "core/models/spatial/matrix-inl.h"
#include "core/models/spatial/problem-inl.h"
#include "core/models/spatial/spatial.h"

HWY_BEFORE_NAMESPACE();
namespace ricochet::spatial::HWY_NAMESPACE {

// The value of a function and its slope.
template <typename T>
struct Rates {
  T value, slope;
};

// Impulses and works count from the start of the phase, so that a short restitution keeps its digits. The normal work
// is the integral of v, and not the change of energy less the work of friction, beside which it may be nothing.
template <typename T>
struct State {
  T tau{0}, f1{0}, f2{0};
  T u1{0}, u2{0}, v{0};
  T friction_work{0}, normal_work{0};

  HWY_INLINE T Slip() const { return SquareRoot(u1 * u1 + u2 * u2); }
};

// A phase ends when this quantity reaches the target: v, tau or the normal work of the phase.
enum class Quantity { kVelocity, kImpulse, kWork };
template <typename T>
struct Goal {
  Quantity quantity;
  T target;
};

// The goal of the present phase, as seen from a state of the path. T is a floating type or a LaneNumber.
template <typename T>
struct PhaseGoal {
  // The value of the goal's quantity.
  HWY_INLINE T Value(const State<T>& at) const {
    return Select(to_velocity, at.v, Select(to_impulse, at.tau, at.normal_work));
  }
  // The goal's quantity less its target, with its slope over xi.
  HWY_INLINE Rates<T> GoalRates(const Contact<T>& contact, const State<T>& at) const {
    const T tau_rate = at.Slip() / contact.rate;
    const T slope = Select(to_impulse, tau_rate, at.v * tau_rate);
    return {Value(at) - target, Select(to_velocity, VelocityRate(contact, at), slope)};
  }
  // dv/dxi
  HWY_INLINE static T VelocityRate(const Contact<T>& contact, const State<T>& at) {
    const Matrix<T>& w = contact.w;
    return (w.w33 * at.Slip() - contact.mu * (w.w13 * at.u1 + w.w23 * at.u2)) / contact.rate;
  }
  // The normal impulse left until the goal if the slopes stay as they are; infinity if the goal is never reached.
  HWY_INLINE T ImpulseToGoal(const Slopes<T>& slopes) const;

  State<T> from;
  T target;
  MaskOf<T> to_velocity, to_impulse;  // The goal is one of v or of tau, and else one of work.
  MaskOf<T> may_turn;                 // The goal's quantity need not grow all the way.
  MaskOf<T> in_restitution;
};

template <typename T>
struct Path {
  explicit Path(const ScaledProblem<T>& its_problem);

  PhaseGoal<T> GoalFromHere() const {
    return {.from = state,
            .target = goal.target,
            .to_velocity = goal.quantity == Quantity::kVelocity,
            .to_impulse = goal.quantity == Quantity::kImpulse,
            .may_turn = problem.may_jam,
            .in_restitution = in_restitution};
  }

  bool IsAtStart() const { return event_count == 1 && state.tau == T{0}; }
  bool Sticks() const {
    return regime == Regime::kStickInCompression || regime == Regime::kStickInRestitution || regime == Regime::kLocked;
  }
  void Record(EventKind kind) { Record(kind, state); }
  void Record(EventKind kind, const State<T>& at);
  // True if a difference of v is what rounding leaves of the changes of v so far.
  bool IsRounding(T difference) const {
    return std::fabs(difference) <= T{2} * kEpsilon<T> * problem.steepest * (compression_end.tau + state.tau);
  }
  // True if v is what Newton's law asks for, but for rounding: a contact that sticks may keep it for ever.
  bool IsAtVelocityGoal() const {
    return in_restitution && goal.quantity == Quantity::kVelocity && IsRounding(goal.target - state.v);
  }
  void SetRegime(Regime of_compression, Regime of_restitution) {
    regime = in_restitution ? of_restitution : of_compression;
  }
  // True if the quantity that ends restitution has fallen since `before`, for the first time: v, or the normal work,
  // which falls where v < 0.
  bool RecedesSince(const State<T>& before) const {
    if (!in_restitution || recedes || goal.quantity == Quantity::kImpulse) return false;
    const T fall = goal.quantity == Quantity::kVelocity ? before.v - state.v : -state.v;
    return fall > T{0} && !IsRounding(fall);
  }
  void RecordReceding(State<T> at) {
    if (goal.quantity == Quantity::kWork) at.v = T{0};  // Root finding has stopped near it.
    recedes = true;
    Record(EventKind::kEndRecedes, at);
  }
  // Ends compression at the present state, and sets the goal of restitution according to the law.
  void StartRestitution();
  void End() {
    if (regime != Regime::kLocked) Record(EventKind::kRestitutionEnds);
    if (!Sticks() && problem.HasNoFriction()) regime = Regime::kFrictionless;
    if (regime == Regime::kUnspecified) regime = Regime::kSliding;
    ended = true;
  }

  const ScaledProblem<T>& problem;
  State<T> state;
  State<T> compression_end;  // 0 until then
  Goal<T> goal = {Quantity::kVelocity, T{0}};
  bool in_restitution = false;
  bool ended = false;
  bool recedes = false;      // The end of restitution has receded.
  bool stops_short = false;  // The contact is held in restitution, before the goal of its law.
  Regime regime = Regime::kUnspecified;
  std::array<Instant, 5> events;
  int event_count = 0;
};

template <typename T>
Path<T>::Path(const ScaledProblem<T>& its_problem)
    : problem(its_problem), state{.u1 = its_problem.u1, .u2 = its_problem.u2, .v = its_problem.v} {
  Record(EventKind::kStart);
}

template <typename T>
HWY_INLINE T PhaseGoal<T>::ImpulseToGoal(const Slopes<T>& slopes) const {
  const T never{kInfinity<Constant<T>>};
  const T zero{0};
  const T missing = target - Value(from);
  const T square = from.v * from.v + T{2} * slopes.v * missing;
  const T root = SquareRoot(square);
  const T while_parting = Select(root > zero, T{2} * missing / (from.v + root), never);
  const T while_closing = Select(slopes.v > zero, (root - from.v) / slopes.v, never);
  const T to_work = Select(square < zero, never, Select(from.v >= zero, while_parting, while_closing));
  const T to_v = Select(slopes.v > zero, missing / slopes.v, never);
  return Select(missing > zero, Select(to_velocity, to_v, Select(to_impulse, missing, to_work)), zero);
}

template <typename T>
void Path<T>::Record(EventKind kind, const State<T>& at) {
  events[static_cast<size_t>(event_count++)] = {
      .kind = kind,
      .tau = problem.Impulse(compression_end.tau + at.tau),
      .f = {problem.Impulse(compression_end.f1 + at.f1), problem.Impulse(compression_end.f2 + at.f2)},
      .u = {problem.Velocity(at.u1), problem.Velocity(at.u2)},
      .v = problem.NormalVelocity(at.v)};
}

template <typename T>
void Path<T>::StartRestitution() {
  const T v_found = state.v;
  state.v = T{0};
  Record(EventKind::kCompressionEnds);
  in_restitution = true;
  compression_end = state;
  state = {.u1 = state.u1, .u2 = state.u2, .v = T{0}};
  const T coefficient = problem.coefficient;
  switch (problem.law) {
    case RestitutionLaw::kNewton:
      goal = {Quantity::kVelocity, -coefficient * problem.v};
      break;
    case RestitutionLaw::kPoisson:
      goal = {Quantity::kImpulse, coefficient * compression_end.tau};
      break;
    case RestitutionLaw::kEnergetic:
      goal = {Quantity::kWork, -coefficient * coefficient * compression_end.normal_work};
      break;
  }
  if (coefficient == T{0}) return;
  // Restitution continues from the v at which root finding stopped, which is not exactly 0, so that v does not jump.
  if (!IsRounding(v_found)) state.v = v_found;
}

}  // namespace ricochet::spatial::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
