// One step of slip that turns: its Taylor series from the present state, and how far that may be followed.

// Per-target include guard.
#if defined(RICOCHET_CORE_MODELS_SPATIAL_STEP_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef RICOCHET_CORE_MODELS_SPATIAL_STEP_INL_H_
#undef RICOCHET_CORE_MODELS_SPATIAL_STEP_INL_H_
#else
#define RICOCHET_CORE_MODELS_SPATIAL_STEP_INL_H_
#endif

#include "core/models/spatial/matrix-inl.h"
#include "core/models/spatial/path-inl.h"
#include "core/models/spatial/problem-inl.h"
#include "core/models/spatial/series-inl.h"
#include "core/models/spatial/step_errors-inl.h"

HWY_BEFORE_NAMESPACE();
namespace ricochet::spatial::HWY_NAMESPACE {

// Finds the root of an increasing function with f(0) < 0 <= f(end) in the lanes `is_sought`. A step that would leave
// the bracket is replaced by a bisection, and the first step of at most `last` times the root is the last one.
template <typename T, typename Function>
HWY_INLINE T FindRoot(const Function& function, MaskOf<T> is_sought, T guess, T end, T last) {
  const T zero{0};
  T low = zero;
  T high = end;
  T x = Select(Both(guess > zero, guess < end), guess, end);
  constexpr int kEnough = 200;
  for (int i = 0; i < kEnough; ++i) {
    is_sought = Both(is_sought, high > low);
    if (InNoLane(is_sought)) break;
    const Rates<T> at = function(x);
    const auto is_below = at.value < zero;
    low = Select(is_below, x, low);
    high = Select(is_below, high, x);
    const T newton = x - at.value / at.slope;
    const auto stays_inside = Both(newton > low, newton < high);
    const auto is_found = Both(Not(stays_inside), Either(at.value == zero, Absolute(newton - x) <= last * x));
    const T next = Select(is_found, x, Select(stays_inside, newton, T{0.5} * (low + high)));
    const auto is_last = Either(is_found, Absolute(next - x) <= last * next);
    x = Select(is_sought, next, x);
    is_sought = Both(is_sought, Not(is_last));
  }
  return x;
}

// Slip that turns, in the frame of its direction.
template <typename T>
struct SlipFrame {
  HWY_INLINE SlipFrame(const Contact<T>& contact, const State<T>& state)
      : slip(state.Slip()),
        frame(contact.FrameAt({state.u1 / slip, state.u2 / slip})),
        scale(Min(contact.velocity, Max(contact.approach, Absolute(state.v)))) {}

  // True where slip is so near to a direction that attracts it that what it still turns by stays below `allowed`, a
  // part of the scale of v, or that its turn is rounding.
  HWY_INLINE MaskOf<T> IsNearlyStraight(T allowed) const {
    const T near{0.1};
    const T turn = Absolute(frame.Turn());
    const T slope = frame.TurnSlope();
    const auto is_negligible =
        Either(turn <= T{kEpsilon<Constant<T>>}, slip * Absolute(frame.Turn() / slope) <= allowed * scale);
    return Both(Both(slope < T{0}, turn <= -near * slope), is_negligible);
  }

  T slip;
  Frame<T> frame;
  T scale;  // of v, to which its errors are relative
};

// A step from the present state of a path, in the direction in which it slips. T is a floating type or a LaneNumber.
template <typename T>
class Step {
 public:
  // The arguments must stay as they are meanwhile.
  HWY_INLINE Step(const Contact<T>& contact, const PhaseGoal<T>& goal, const SlipFrame<T>& slip_frame, int order);

  HWY_INLINE State<T> At(T xi) const;
  // The largest xi at which the errors of the velocities, over their scales, stay below `allowed`.
  HWY_INLINE T AccurateEnd(T allowed) const;
  // `end`, or an earlier xi up to which the quantity that ends the phase grows monotonically.
  HWY_INLINE T MonotonicEnd(T end) const {
    const auto across = [this](T xi) HWY_ATTR { return SlipAcrossCoupling(xi); };
    const auto normal = [this](T xi) HWY_ATTR { return NormalRate(xi); };
    const auto velocity = [this](T xi) HWY_ATTR { return NormalVelocity(xi); };
    end = EndAtSignChange(across, goal_.may_turn, end);
    end = EndAtSignChange(normal, goal_.may_turn, end);
    return EndAtSignChange(velocity, Both(Both(goal_.may_turn, goal_.in_restitution), Not(goal_.from.v == T{0})), end);
  }
  // Finds the xi at which the phase reaches its goal, in the lanes `is_reached`, to `relative` of itself. It is at most
  // `end`.
  HWY_INLINE T GoalWithin(MaskOf<T> is_reached, T end, T relative) const {
    const T guess = goal_.ImpulseToGoal(contact_.SlopesAlong({frame_.c, frame_.s})) * contact_.rate / slip_;
    const auto rates = [this](T xi) HWY_ATTR { return goal_.GoalRates(contact_, At(xi)); };
    return Select(is_reached, FindRoot<T>(rates, is_reached, guess, end, relative), end);
  }

  // The error at xi, where the state is `end` and slip has the direction `e`.
  HWY_INLINE StepError<T> ErrorAt(T xi, const State<T>& end, const Direction<T>& e) const;

 private:
  HWY_INLINE PathError<T> ErrorOf(const SeriesTerm<T>& term, const State<T>& end, const Direction<T>& e) const;
  // The slip of the series and its slopes over xi.
  struct SlipRates {
    T x, y, size;
    T x_slope, y_slope;
  };
  HWY_INLINE SlipRates SlipAt(T xi) const;
  // Three quantities over xi: the component of slip across wtn, which vanishes where v' is extremal; v' times slip; v.
  HWY_INLINE Rates<T> SlipAcrossCoupling(T xi) const {
    const SlipRates at = SlipAt(xi);
    return {-frame_.w2 * at.x + frame_.w1 * at.y, -frame_.w2 * at.x_slope + frame_.w1 * at.y_slope};
  }
  HWY_INLINE Rates<T> NormalRate(T xi) const;
  HWY_INLINE Rates<T> NormalVelocity(T xi) const {
    const State<T> at = At(xi);
    return {at.v, goal_.VelocityRate(contact_, at)};
  }
  // `end`, or the xi before it where the quantity changes its sign, where that counts.
  template <typename Function>
  HWY_INLINE static T EndAtSignChange(const Function& quantity, MaskOf<T> counts, T end);

  const Contact<T>& contact_;
  const PhaseGoal<T>& goal_;
  const Frame<T>& frame_;
  const T slip_;
  const T scale_;  // of v
  const int order_;
  const T friction_unit_, work_unit_;
  SlipSeries<T> series_;
};

template <typename T>
HWY_INLINE Step<T>::Step(const Contact<T>& contact, const PhaseGoal<T>& goal, const SlipFrame<T>& slip_frame, int order)
    : contact_(contact),
      goal_(goal),
      frame_(slip_frame.frame),
      slip_(slip_frame.slip),
      scale_(slip_frame.scale),
      order_(order),
      friction_unit_(contact.largest_root * contact.mu * slip_ / contact.rate),
      work_unit_(contact.mu * slip_ * slip_ / contact.rate) {
  series_.Expand(frame_, order);
}

template <typename T>
HWY_INLINE State<T> Step<T>::At(T xi) const {
  const SeriesValues<T> values = series_.At(xi);
  const State<T>& from = goal_.from;
  const Matrix<T>& w = contact_.w;
  const T mu = contact_.mu;
  const T unit = slip_ / contact_.rate;
  const T tau = unit * values.s_integral;
  const T f1 = -mu * unit * (frame_.c * values.x_integral - frame_.s * values.y_integral);
  const T f2 = -mu * unit * (frame_.s * values.x_integral + frame_.c * values.y_integral);
  const T v = from.v + (w.w33 * tau + w.w13 * f1 + w.w23 * f2);
  return {.tau = from.tau + tau,
          .f1 = from.f1 + f1,
          .f2 = from.f2 + f2,
          .u1 = slip_ * (frame_.c * values.x - frame_.s * values.y),
          .u2 = slip_ * (frame_.s * values.x + frame_.c * values.y),
          .v = v,
          .friction_work = from.friction_work - mu * slip_ * unit * values.square_integral,
          .normal_work = from.normal_work + (T{0.5} * tau * (from.v + v) - work_unit_ * values.trapezoid_excess)};
}

// The terms beyond the last one are taken for a geometric series that starts at the larger of the values to which the
// last two lead.
template <typename T>
HWY_INLINE StepError<T> Step<T>::ErrorAt(T xi, const State<T>& end, const Direction<T>& e) const {
  const LastTerms<T> terms = series_.LastTermsAt(xi);
  const PathError<T> before = ErrorOf(terms.before, end, e);
  const PathError<T> last = ErrorOf(terms.last, end, e);
  const auto size = [](const PathError<T>& of) HWY_ATTR { return Absolute(of.f1) + Absolute(of.f2); };
  const T q = terms.ratio;
  StepError<T> error = {.known = before, .remainder = last};
  error.known.Add(last, T{1});
  const auto falls_fast = size(before) * q > size(last);
  const T factor = T{3} * q / (T{1} - q) * Select(falls_fast, q, T{1});
  error.remainder = {.f1 = factor * Select(falls_fast, before.f1, last.f1),
                     .f2 = factor * Select(falls_fast, before.f2, last.f2),
                     .work = factor * Select(falls_fast, before.work, last.work)};
  return error;
}

// The error of tau counts, too: at equal tau the friction impulse and its work lack less, because both grow over the
// missing tau. The change of energy is u.df, and the normal work is that less the work of friction.
template <typename T>
HWY_INLINE PathError<T> Step<T>::ErrorOf(const SeriesTerm<T>& term, const State<T>& end, const Direction<T>& e) const {
  const T unit = contact_.mu * slip_ / contact_.rate;
  const T late = unit * term.s_integral;
  const T f1 = late * e.c - unit * (frame_.c * term.x_integral - frame_.s * term.y_integral);
  const T f2 = late * e.s - unit * (frame_.s * term.x_integral + frame_.c * term.y_integral);
  const T friction_work = late * (end.u1 * e.c + end.u2 * e.s) - unit * slip_ * term.square_integral;
  return {.f1 = f1, .f2 = f2, .work = end.u1 * f1 + end.u2 * f2 - friction_work};
}

template <typename T>
HWY_INLINE T Step<T>::AccurateEnd(T allowed) const {
  // However small the slip is, the step stays within the convergence of the series, and comes nearer to a direction
  // that attracts slip.
  const T off = Absolute(frame_.Turn() / frame_.TurnSlope());
  const T nearer = Select(frame_.TurnSlope() < T{0}, Max(T{0.1} * off, T{kEpsilon<Constant<T>>}), T{1});
  const T relative = Min(internal::Power(T{0.5}, 4 * order_ / 5), nearer);
  const T of_velocity = Min(allowed * contact_.velocity / (contact_.largest_root * friction_unit_),
                            allowed * scale_ / (contact_.normal_root * friction_unit_));
  const T of_work = allowed * scale_ * scale_ / (contact_.steepest * work_unit_);
  return series_.LongestStep(Min(of_velocity, relative), Min(of_work, relative));
}

template <typename T>
template <typename Function>
HWY_INLINE T Step<T>::EndAtSignChange(const Function& quantity, MaskOf<T> counts, T end) {
  const T zero{0};
  if (InNoLane(counts)) return end;
  const T first = quantity(zero).value;
  const T last = quantity(end).value;
  const auto changes = Both(counts, Differ(first < zero, last < zero));
  if (InNoLane(changes)) return end;
  const T sign = Select(first < zero, T{1}, T{-1});
  const auto increasing = [&](T xi) HWY_ATTR {
    const Rates<T> here = quantity(xi);
    return Rates<T>{sign * here.value, sign * here.slope};
  };
  const T negligible{1e-6};
  const T root = FindRoot<T>(increasing, changes, end, end, T{1e-9});
  return Select(Both(changes, root > negligible * end), root, end);
}

template <typename T>
HWY_INLINE typename Step<T>::SlipRates Step<T>::SlipAt(T xi) const {
  const SeriesValues<T> at = series_.At(xi);
  const T size = SquareRoot(at.x * at.x + at.y * at.y);
  return {.x = at.x,
          .y = at.y,
          .size = size,
          .x_slope = frame_.a11 * at.x + frame_.a12 * at.y + frame_.w1 * size,
          .y_slope = frame_.a12 * at.x + frame_.a22 * at.y + frame_.w2 * size};
}

template <typename T>
HWY_INLINE Rates<T> Step<T>::NormalRate(T xi) const {
  const SlipRates at = SlipAt(xi);
  const T wnn = contact_.w.w33 / contact_.rate;
  const T size_slope = (at.x * at.x_slope + at.y * at.y_slope) / at.size;
  return {wnn * at.size - contact_.mu * (frame_.w1 * at.x + frame_.w2 * at.y),
          wnn * size_slope - contact_.mu * (frame_.w1 * at.x_slope + frame_.w2 * at.y_slope)};
}

// The outcome of a step.
template <typename T>
struct StepEnd {
  State<T> state;
  Direction<T> e;  // of slip
  StepErrors<T> errors;
  T overshoot;             // how far the goal's quantity lies beyond the goal at the accurate end
  MaskOf<T> reaches_goal;  // The step ends at the goal, which counts as reached.
  T distance_to_goal;      // the distance from the goal, in normal impulse, where it is reached
};

// Follows slip as far as its error stays below a share of the tolerance, and not beyond the goal of the phase.
template <typename T>
HWY_INLINE StepEnd<T> TakeStep(const Contact<T>& contact, const PhaseGoal<T>& goal, const StepErrors<T>& errors,
                               const SlipFrame<T>& slip_frame, T tolerance, int order) {
  const T step_share{0.175};
  const Step<T> step(contact, goal, slip_frame, order);
  T xi = step.AccurateEnd(step_share * tolerance);
  if (!InNoLane(goal.may_turn)) xi = step.MonotonicEnd(xi);
  State<T> state = step.At(xi);
  const T overshoot = goal.Value(state) - goal.target;
  const auto reaches_goal = overshoot >= T{0};
  T distance{0};
  if (!InNoLane(reaches_goal)) {
    xi = step.GoalWithin(reaches_goal, xi, T{1e-2} * SquareRoot(tolerance));
    state = step.At(xi);
    const Rates<T> rates = goal.GoalRates(contact, state);
    distance = T{2} * Absolute(rates.value / rates.slope) * state.Slip() / contact.rate;
  }
  const T slip = state.Slip();
  const Direction<T> e = {state.u1 / slip, state.u2 / slip};
  const Stretch<T> stretch = {.length = state.tau - goal.from.tau,
                              .m = {slip_frame.frame.c + e.c, slip_frame.frame.s + e.s},
                              .first_slip = slip_frame.slip,
                              .last_slip = slip};
  StepErrors<T> sum = errors;
  sum.AddStep(contact, step.ErrorAt(xi, state, e), stretch, state.v);
  return {.state = state,
          .e = e,
          .errors = sum,
          .overshoot = overshoot,
          .reaches_goal = reaches_goal,
          .distance_to_goal = distance};
}

}  // namespace ricochet::spatial::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
