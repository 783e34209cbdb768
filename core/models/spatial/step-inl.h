// One step of slip that turns: its Taylor series from the present state, and how far that may be followed.

// Per-target include guard.
#if defined(RICOCHET_CORE_MODELS_SPATIAL_STEP_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef RICOCHET_CORE_MODELS_SPATIAL_STEP_INL_H_
#undef RICOCHET_CORE_MODELS_SPATIAL_STEP_INL_H_
#else
#define RICOCHET_CORE_MODELS_SPATIAL_STEP_INL_H_
#endif

#include <algorithm>
#include <cmath>

#include "core/models/spatial/error_ledger-inl.h"
#include "core/models/spatial/matrix-inl.h"
#include "core/models/spatial/path-inl.h"
#include "core/models/spatial/problem-inl.h"
#include "core/models/spatial/series-inl.h"

HWY_BEFORE_NAMESPACE();
namespace ricochet::spatial::HWY_NAMESPACE {

// The root of an increasing function with f(0) < 0 <= f(end), from a first guess. A step that would leave the bracket
// is replaced by a bisection, and the first step of at most `last` times the root is the last one.
template <typename T, typename Function>
T FindRoot(const Function& function, T guess, T end, T last) {
  T low{0};
  T high = end;
  T x = guess > T{0} && guess < end ? guess : end;
  constexpr int kEnough = 200;
  for (int i = 0; i < kEnough && high > low; ++i) {
    const Rates<T> at = function(x);
    (at.value < T{0} ? low : high) = x;
    T next = x - at.value / at.slope;
    if (!(next > low && next < high)) {
      if (at.value == T{0} || std::fabs(next - x) <= last * x) return x;
      next = T{0.5} * (low + high);
    }
    if (std::fabs(next - x) <= last * next) return next;
    x = next;
  }
  return x;
}

template <typename T>
class Step {
 public:
  // The state of `path` slips along e = (frame.c, frame.s) with the size `slip`, and must stay as it is meanwhile.
  Step(const ScaledProblem<T>& problem, const Path<T>& path, const Frame<T>& frame, T slip, int order);

  State<T> At(T xi) const;
  // The largest xi at which the errors of the velocities stay below `allowed`.
  T AccurateEnd(T allowed) const;
  // `end`, or an earlier xi up to which the quantity that ends the phase grows monotonically.
  T MonotonicEnd(T end) const {
    end = EndAtSignChange([this](T xi) { return SlipAcrossCoupling(xi); }, end);
    end = EndAtSignChange([this](T xi) { return NormalRate(xi); }, end);
    if (!path_.in_restitution || path_.state.v == T{0}) return end;
    return EndAtSignChange([this](T xi) { return NormalVelocity(xi); }, end);
  }
  // The xi at which the phase reaches its goal, which is at most `end`; found to `relative` of itself.
  T GoalWithin(T end, T relative) const {
    const T guess = path_.ImpulseToGoal(problem_.SlopesAlong({frame_.c, frame_.s})) * problem_.rate / slip_;
    return FindRoot<T>([this](T xi) { return path_.GoalRates(At(xi)); }, guess, end, relative);
  }

  // The error at xi, where the state is `end` and slip has the direction `e`.
  StepError<T> ErrorAt(T xi, const State<T>& end, const Direction<T>& e) const;

 private:
  PathError<T> ErrorOf(const SeriesTerm<T>& term, const State<T>& end, const Direction<T>& e) const;
  // The slip of the series and its slopes over xi.
  struct SlipRates {
    T x, y, size;
    T x_slope, y_slope;
  };
  SlipRates SlipAt(T xi) const;
  // Three quantities over xi: the component of slip across wtn, which vanishes where v' is extremal; v' times slip; v.
  Rates<T> SlipAcrossCoupling(T xi) const {
    const SlipRates at = SlipAt(xi);
    return {-frame_.w2 * at.x + frame_.w1 * at.y, -frame_.w2 * at.x_slope + frame_.w1 * at.y_slope};
  }
  Rates<T> NormalRate(T xi) const;
  Rates<T> NormalVelocity(T xi) const {
    const State<T> at = At(xi);
    return {at.v, path_.VelocityRate(at)};
  }
  // `end`, or the xi before it where the quantity changes its sign.
  template <typename Function>
  static T EndAtSignChange(const Function& quantity, T end);

  const ScaledProblem<T>& problem_;
  const Path<T>& path_;
  const Frame<T>& frame_;
  const T slip_;
  const int order_;
  const T friction_unit_, work_unit_;
  SlipSeries<T> series_;
};

template <typename T>
Step<T>::Step(const ScaledProblem<T>& problem, const Path<T>& path, const Frame<T>& frame, T slip, int order)
    : problem_(problem),
      path_(path),
      frame_(frame),
      slip_(slip),
      order_(order),
      friction_unit_(problem.largest_root * problem.mu * slip / problem.rate),
      work_unit_(problem.mu * slip * slip / problem.rate) {
  series_.Expand(frame, order);
}

template <typename T>
State<T> Step<T>::At(T xi) const {
  const SeriesValues<T> values = series_.At(xi);
  const State<T>& from = path_.state;
  const Matrix<T>& w = problem_.w;
  const T mu = problem_.mu;
  const T unit = slip_ / problem_.rate;
  const T tau = unit * values.s_integral;
  const T f1 = -mu * unit * (frame_.c * values.x_integral - frame_.s * values.y_integral);
  const T f2 = -mu * unit * (frame_.s * values.x_integral + frame_.c * values.y_integral);
  return {.tau = from.tau + tau,
          .f1 = from.f1 + f1,
          .f2 = from.f2 + f2,
          .u1 = slip_ * (frame_.c * values.x - frame_.s * values.y),
          .u2 = slip_ * (frame_.s * values.x + frame_.c * values.y),
          .v = from.v + (w.w33 * tau + w.w13 * f1 + w.w23 * f2),
          .friction_work = from.friction_work - mu * slip_ * unit * values.square_integral};
}

// The terms beyond the last one are taken for a geometric series that starts at the larger of the values to which the last two lead.
template <typename T>
StepError<T> Step<T>::ErrorAt(T xi, const State<T>& end, const Direction<T>& e) const {
  const LastTerms<T> terms = series_.LastTermsAt(xi);
  const PathError<T> before = ErrorOf(terms.before, end, e);
  const PathError<T> last = ErrorOf(terms.last, end, e);
  const auto size = [](const PathError<T>& of) { return std::fabs(of.f1) + std::fabs(of.f2); };
  const T q = terms.ratio;
  StepError<T> error = {.known = before, .rest = size(before) * q > size(last) ? before : last};
  error.known.Add(last, T{1});
  const T factor = T{3} * q / (T{1} - q) * (size(before) * q > size(last) ? q : T{1});
  error.rest = {.f1 = factor * error.rest.f1, .f2 = factor * error.rest.f2, .work = factor * error.rest.work};
  return error;
}

// A lack in tau counts, too: at equal tau the friction impulse and its work lack less, as both would have gone on
// meanwhile. The change of energy is u.df, and the normal work is that less the work of friction.
template <typename T>
PathError<T> Step<T>::ErrorOf(const SeriesTerm<T>& term, const State<T>& end, const Direction<T>& e) const {
  const T unit = problem_.mu * slip_ / problem_.rate;
  const T late = unit * term.s_integral;
  const T f1 = late * e.c - unit * (frame_.c * term.x_integral - frame_.s * term.y_integral);
  const T f2 = late * e.s - unit * (frame_.s * term.x_integral + frame_.c * term.y_integral);
  const T friction_work = late * (end.u1 * e.c + end.u2 * e.s) - unit * slip_ * term.square_integral;
  return {.f1 = f1, .f2 = f2, .work = end.u1 * f1 + end.u2 * f2 - friction_work};
}

template <typename T>
T Step<T>::AccurateEnd(T allowed) const {
  // However small the slip is, the step stays within the convergence of the series, and comes nearer to a direction
  // that attracts slip.
  const T off = std::fabs(frame_.Turn() / frame_.TurnSlope());
  const T nearer = frame_.TurnSlope() < T{0} ? std::max(T{0.1} * off, kEpsilon<T>) : T{1};
  const T relative = std::min(internal::Power(T{0.5}, 4 * order_ / 5), nearer);
  const T velocity_per_friction = std::max(problem_.largest_root, problem_.normal_root);
  return series_.LongestStep(std::min(allowed / (velocity_per_friction * friction_unit_), relative),
                             std::min(allowed * problem_.velocity / (problem_.steepest * work_unit_), relative));
}

template <typename T>
template <typename Function>
T Step<T>::EndAtSignChange(const Function& quantity, T end) {
  constexpr T kNegligible{1e-6};
  const Rates<T> first = quantity(T{0});
  const Rates<T> last = quantity(end);
  if ((first.value < T{0}) == (last.value < T{0})) return end;
  const T sign = first.value < T{0} ? T{1} : T{-1};
  const auto increasing = [&](T xi) {
    const Rates<T> here = quantity(xi);
    return Rates<T>{sign * here.value, sign * here.slope};
  };
  const T root = FindRoot<T>(increasing, end, end, T{1e-9});
  return root > kNegligible * end ? root : end;
}

template <typename T>
typename Step<T>::SlipRates Step<T>::SlipAt(T xi) const {
  const SeriesValues<T> at = series_.At(xi);
  const T size = std::sqrt(at.x * at.x + at.y * at.y);
  return {.x = at.x,
          .y = at.y,
          .size = size,
          .x_slope = frame_.a11 * at.x + frame_.a12 * at.y + frame_.w1 * size,
          .y_slope = frame_.a12 * at.x + frame_.a22 * at.y + frame_.w2 * size};
}

template <typename T>
Rates<T> Step<T>::NormalRate(T xi) const {
  const SlipRates at = SlipAt(xi);
  const T wnn = problem_.w.w33 / problem_.rate;
  const T size_slope = (at.x * at.x_slope + at.y * at.y_slope) / at.size;
  return {wnn * at.size - problem_.mu * (frame_.w1 * at.x + frame_.w2 * at.y),
          wnn * size_slope - problem_.mu * (frame_.w1 * at.x_slope + frame_.w2 * at.y_slope)};
}

}  // namespace ricochet::spatial::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
