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
#include <limits>

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

// Impulses and work count from the start of the phase, so that a short restitution keeps its digits.
template <typename T>
struct State {
  T tau{0}, f1{0}, f2{0};
  T u1{0}, u2{0}, v{0};
  T friction_work{0};

  T Slip() const { return std::sqrt(u1 * u1 + u2 * u2); }
};

// A phase ends when this quantity reaches the target: v, tau or the normal work of the phase.
enum class Quantity { kVelocity, kImpulse, kWork };
template <typename T>
struct Goal {
  Quantity quantity;
  T target;
};

template <typename T>
struct Path {
  explicit Path(const ScaledProblem<T>& its_problem);

  // The value of the goal's quantity.
  T Value(const State<T>& at) const {
    switch (goal.quantity) {
      case Quantity::kVelocity:
        return at.v;
      case Quantity::kImpulse:
        return at.tau;
      case Quantity::kWork:
        break;
    }
    return NormalWork(at);
  }
  // The goal's quantity less its target, with its slope over xi.
  Rates<T> GoalRates(const State<T>& at) const {
    const T value = Value(at) - goal.target;
    if (goal.quantity == Quantity::kVelocity) return {value, VelocityRate(at)};
    const T tau_rate = at.Slip() / problem.rate;
    return {value, goal.quantity == Quantity::kImpulse ? tau_rate : at.v * tau_rate};
  }
  // dv/dxi
  T VelocityRate(const State<T>& at) const {
    const Matrix<T>& w = problem.w;
    return (w.w33 * at.Slip() - problem.mu * (w.w13 * at.u1 + w.w23 * at.u2)) / problem.rate;
  }
  // The normal work of this phase, which is the change of energy that friction did not make.
  T NormalWork(const State<T>& at) const {
    return T{0.5} *
               (at.f1 * (at.u1 + phase_start.u1) + at.f2 * (at.u2 + phase_start.u2) + at.tau * (at.v + phase_start.v)) -
           at.friction_work;
  }
  // The normal impulse left until the goal if the slopes stay as they are; infinity if the goal is never reached.
  T ImpulseToGoal(const Slopes<T>& slopes) const;

  bool IsAtStart() const { return event_count == 1 && state.tau == T{0}; }
  bool Sticks() const {
    return regime == Regime::kStickInCompression || regime == Regime::kStickInRestitution || regime == Regime::kLocked;
  }
  void Record(EventKind kind);
  void SetRegime(Regime of_compression, Regime of_restitution) {
    regime = in_restitution ? of_restitution : of_compression;
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
  State<T> phase_start;
  State<T> compression_end;  // 0 until then
  Goal<T> goal = {Quantity::kVelocity, T{0}};
  T compression_work{0};
  bool in_restitution = false;
  bool ended = false;
  Regime regime = Regime::kUnspecified;
  std::array<Instant, 4> events;
  int event_count = 0;
};

template <typename T>
Path<T>::Path(const ScaledProblem<T>& its_problem)
    : problem(its_problem), state{.u1 = its_problem.u1, .u2 = its_problem.u2, .v = its_problem.v}, phase_start(state) {
  Record(EventKind::kStart);
}

template <typename T>
T Path<T>::ImpulseToGoal(const Slopes<T>& slopes) const {
  const T missing = goal.target - Value(state);
  if (!(missing > T{0})) return T{0};
  switch (goal.quantity) {
    case Quantity::kVelocity:
      return slopes.v > T{0} ? missing / slopes.v : kInfinity<T>;
    case Quantity::kImpulse:
      return missing;
    case Quantity::kWork:
      break;
  }
  const T square = state.v * state.v + T{2} * slopes.v * missing;
  if (square < T{0}) return kInfinity<T>;
  const T root = std::sqrt(square);
  if (state.v >= T{0}) return root > T{0} ? T{2} * missing / (state.v + root) : kInfinity<T>;
  return slopes.v > T{0} ? (root - state.v) / slopes.v : kInfinity<T>;
}

template <typename T>
void Path<T>::Record(EventKind kind) {
  events[static_cast<size_t>(event_count++)] = {
      .kind = kind,
      .tau = problem.Impulse(compression_end.tau + state.tau),
      .f = {problem.Impulse(compression_end.f1 + state.f1), problem.Impulse(compression_end.f2 + state.f2)},
      .u = {problem.Velocity(state.u1), problem.Velocity(state.u2)},
      .v = problem.Velocity(state.v)};
}

template <typename T>
void Path<T>::StartRestitution() {
  const T v_found = state.v;
  compression_work = NormalWork(state);
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
      goal = {Quantity::kWork, -coefficient * coefficient * compression_work};
      break;
  }
  if (coefficient == T{0}) return;
  // Restitution continues from the v at which root finding stopped, which is not exactly 0, so that v does not jump.
  state.v = v_found;
  phase_start = state;
}

}  // namespace ricochet::spatial::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
