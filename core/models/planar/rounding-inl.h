// Rounding of a planar path: bounds on the errors of the numbers reported, and the signs that plain arithmetic
// is sure of.
//
// Errors are counted in roundings: an error of 3 is three times the largest relative error of one operation, 2^-53 in
// plain arithmetic and below 2^-102 in double-double. The count follows the path piece by piece; the one difference
// that may cancel is v where slip stops, and everything after it is as good as that difference over the slope of v.
// docs/theory/rounding_planar.md derives every line.

// Per-target include guard.
#if defined(RICOCHET_CORE_MODELS_PLANAR_ROUNDING_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef RICOCHET_CORE_MODELS_PLANAR_ROUNDING_INL_H_
#undef RICOCHET_CORE_MODELS_PLANAR_ROUNDING_INL_H_
#else
#define RICOCHET_CORE_MODELS_PLANAR_ROUNDING_INL_H_
#endif

#include "core/models/impact_errors.h"
#include "core/models/planar/kernel-inl.h"
#include "core/models/planar/planar.h"
#include "core/models/planar/report-inl.h"
#include "core/models/restitution_law.h"
#include "core/numerics/sizes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace ricochet::planar::HWY_NAMESPACE {

using ricochet::HWY_NAMESPACE::DoubleDouble;

// No number on the path leaves the range in which DoubleDouble is exact if every input is 0 or has a size between
// kLeastModerate and kMostModerate, u0 and Wtn one between kLeastCoupling and kMostModerate: both are often the
// rounding error of a number that should be 0. Slopes then lie between 2^-186 (two products of 2^-80 that cancel to
// their last bit) and 2^81, v where slip stops is below 2^307, impulses are below 2^493, works below 2^800, and v^2
// over a slope is above 2^-908. Products with u0 and Wtn are above 2^-286.
inline constexpr double kLeastModerate = 0x1p-40;
inline constexpr double kMostModerate = 0x1p40;
inline constexpr double kLeastCoupling = 0x1p-100;

// A sign is sure if the number is this many times its error, so that every number that later ones divide by is right to
// 2^-10.
inline constexpr double kSure = 0x1p10;
// Covers products of errors, which the counts leave out.
inline constexpr double kHigherOrders = 1.0 + 0x1p-5;

// A number in the type in which errors are counted: N itself, but plain for a double-double.
template <typename N>
HWY_INLINE N Coarse(const N& x) {
  return x;
}
template <typename V>
HWY_INLINE Plain<V> Coarse(const DoubleDouble<V>& x) {
  return Plain<V>(x.hi);
}
template <typename N>
using CoarseOf = decltype(Coarse(N()));

// True where DoubleDouble is exact on the whole path.
template <typename N>
HWY_INLINE MaskOf<CoarseOf<N>> IsModerate(const Inputs<N>& in) {
  ricochet::HWY_NAMESPACE::Sizes<RoundedOf<N>> sizes;
  ricochet::HWY_NAMESPACE::Sizes<RoundedOf<N>> couplings;
  for (const N* x : {&in.wtt, &in.wnn, &in.v0, &in.mu, &in.mu_static, &in.coefficient}) sizes.Include(Coarse(*x).value);
  for (const N* x : {&in.wtn, &in.stated_u0}) couplings.Include(Coarse(*x).value);
  return Both(sizes.AreWithin(kLeastModerate, kMostModerate), couplings.AreWithin(kLeastCoupling, kMostModerate));
}

template <typename M>
HWY_INLINE M Times(double count, const M& x) {
  return M::Constant(count) * x;
}
template <typename M>
HWY_INLINE M Larger(const M& x, const M& y) {
  return Select(IsNegative(x - y), y, x);
}

template <typename V>
HWY_INLINE Plain<V> Larger(const Plain<V>& x, const Plain<V>& y) {
  return Plain<V>(ricochet::HWY_NAMESPACE::Larger(x.value, y.value));
}

// Errors at the end of an impact.
template <typename M>
struct EndErrors {
  M tau, f, u, v;
  M works;  // Twice the error of each work and of the change of energy.
  // The difference that decides whether slip stops during restitution, and its error; 0 and 0 if nothing does.
  M decisive, decisive_error;
  // The errors of the normal impulses of compression, from the stop of slip to its end, and of restitution up to the
  // stop and after it; of u where v = 0.
  M tau_compression, stuck, before, after, u_compression;
};

template <typename M>
HWY_INLINE EndErrors<M> SelectErrors(const MaskOf<M>& condition, const EndErrors<M>& yes, const EndErrors<M>& no) {
  return {.tau = Select(condition, yes.tau, no.tau),
          .f = Select(condition, yes.f, no.f),
          .u = Select(condition, yes.u, no.u),
          .v = Select(condition, yes.v, no.v),
          .works = Select(condition, yes.works, no.works),
          .decisive = Select(condition, yes.decisive, no.decisive),
          .decisive_error = Select(condition, yes.decisive_error, no.decisive_error),
          .tau_compression = Select(condition, yes.tau_compression, no.tau_compression),
          .stuck = Select(condition, yes.stuck, no.stuck),
          .before = Select(condition, yes.before, no.before),
          .after = Select(condition, yes.after, no.after),
          .u_compression = Select(condition, yes.u_compression, no.u_compression)};
}

// Twice the sum of the magnitudes of the four works.
template <typename N, typename M = CoarseOf<N>>
HWY_INLINE M TwiceTotalWork(const Solution<N>& x) {
  return Coarse(x.restitution.normal) - Coarse(x.compression.normal) + Abs(Coarse(x.compression.tangential)) +
         Abs(Coarse(x.restitution.tangential));
}

// The error of v where slip stops. It is exact where no difference is computed.
template <typename N, typename M = CoarseOf<N>>
HWY_INLINE M StopError(const Course<N>& course) {
  const MaskOf<M> is_computed = Both(Not(course.in.u_follows_v), course.path.slips_first);
  if (InNoLane(is_computed)) return Zero<M>();
  const M v_stop = Coarse(course.path.v_stop);
  const M error = Times(2.0, Abs(v_stop - Coarse(course.in.v0))) + Times(3.0, Abs(v_stop));
  return Select(is_computed, error, Zero<M>());
}

// The error of u where v = 0 on the first piece. At rank one u is 0 there, or u0.
template <typename N, typename M = CoarseOf<N>>
HWY_INLINE M UCompressionError(const Course<N>& course) {
  const M u_c = Coarse(course.x.compression_end.u);
  const M error = Times(2.0, Abs(u_c - Coarse(course.in.u0))) + Times(3.0, Abs(u_c));
  return Select(course.in.u_follows_v, Zero<M>(), error);
}

// The errors of the works, from those of the end and `works`, the sum of those of the works one by one.
template <typename N, typename M>
HWY_INLINE M WithEnergyChange(const Course<N>& course, const EndErrors<M>& end, const M& f_path, const M& works) {
  const State<N>& at = course.x.end;
  const M u0 = Coarse(course.in.u0);
  const M tau = Coarse(at.tau);
  const M u_sum = Abs(u0 + Coarse(at.u));
  const M v_sum = Abs(Coarse(course.in.v0) + Coarse(at.v));
  const M u_errors = Select(course.in.u_follows_v, end.u + Times(2.0, Abs(u0)), end.u);
  const M change =
      u_sum * (end.f + Times(3.0, f_path)) + f_path * u_errors + v_sum * (end.tau + Times(3.0, tau)) + tau * end.v;
  return Larger(works, change);
}

// The whole impact lies on the first piece.
template <typename N, typename M = CoarseOf<N>>
HWY_INLINE EndErrors<M> OnePieceErrors(const Course<N>& course) {
  const RestitutionLaw law = course.law;
  const Solution<N>& x = course.x;
  // Roundings of the step of restitution and of v1.
  const double in_step = law == RestitutionLaw::kEnergetic ? 6.5 : 3.0;
  const double in_v1 = law == RestitutionLaw::kNewton ? 1.0 : law == RestitutionLaw::kPoisson ? 5.0 : 4.5;
  const M tau_c = Coarse(x.compression_end.tau);
  const M tau = Coarse(x.end.tau);
  const M v1 = Coarse(x.end.v);
  const M u_c = Coarse(x.compression_end.u);
  const M u1 = Coarse(x.end.u);
  EndErrors<M> errors;
  errors.tau = Times(2.0, tau_c) + Times(in_step, tau - tau_c) + tau;
  errors.f = Abs(Coarse(course.path.first.f)) * (errors.tau + tau);
  errors.v = Times(in_v1, v1);
  errors.u_compression = UCompressionError(course);
  const M u_errors = errors.u_compression + Times(in_step + 2.0, Abs(u1 - u_c)) + Abs(u1);
  errors.u = Select(course.in.u_follows_v, Zero<M>(), u_errors);
  // At rank one u' has two roundings more.
  const MaskOf<N> has_more = Both(course.in.rank_one, Not(course.in.u_follows_v));
  if (!InNoLane(has_more)) errors.u = errors.u + Select(has_more, Times(2.0, Abs(u1 - u_c)), Zero<M>());
  errors.works = Times(36.0, TwiceTotalWork(x));
  errors.tau_compression = Times(2.0, tau_c);
  errors.before = Times(in_step, tau - tau_c);
  errors.stuck = errors.after = Zero<M>();
  errors.decisive = errors.decisive_error = Zero<M>();
  const MaskOf<M> may_stop = Both(course.path.stops, Not(course.in.u_follows_v));
  if (!InNoLane(may_stop)) {
    errors.decisive = Select(may_stop, Coarse(course.path.v_stop) - v1, errors.decisive);
    errors.decisive_error = Select(may_stop, StopError(course) + errors.v, errors.decisive_error);
  }
  return errors;
}

// Slip stops before the end of compression.
template <typename N, typename M = CoarseOf<N>>
HWY_INLINE EndErrors<M> StopInCompressionErrors(const Course<N>& course) {
  const RestitutionLaw law = course.law;
  const Solution<N>& x = course.x;
  const Slopes<N>& second = course.path.second;
  const M slope = Coarse(second.v);
  const M f_slope = Abs(Coarse(second.f));
  const M stop = Coarse(x.stop.tau);
  const M stuck = Coarse(x.stuck_compression);
  const M step = Coarse(x.rebound.before);
  const M tau_c = Coarse(x.compression_end.tau);
  const M tau = Coarse(x.end.tau);
  const M u1 = Abs(Coarse(x.end.u));
  const M v1 = Coarse(x.end.v);
  const M v_stop_error = StopError(course);
  const M stuck_error = v_stop_error / slope + Times(5.0, stuck);
  const M tau_c_error = Times(2.0, stop) + stuck_error + tau_c;
  const M normal_error = v_stop_error * (stop + Times(2.0, stuck));
  EndErrors<M> errors;
  M step_error = Times(6.0, step);
  errors.v = v1;
  if (law == RestitutionLaw::kPoisson) {
    step_error = Coarse(course.in.coefficient) * tau_c_error + step;
    errors.v = slope * step_error + Times(5.0, v1);
  } else if (law == RestitutionLaw::kEnergetic) {
    const M relative = Times(0.5, normal_error) / -Coarse(x.compression.normal) + M::Constant(8.0);
    step_error = step * (relative + M::Constant(5.0));
    errors.v = v1 * relative;
  }
  const M steps_error = stuck_error + step_error;
  const M steps = stuck + step;
  const M f_path = Abs(Coarse(x.stop.f)) + f_slope * steps;
  errors.tau = tau_c_error + step_error + tau;
  errors.f = f_slope * steps_error + Times(5.0, f_path);
  errors.u = Abs(Coarse(second.u)) * steps_error + Times(5.0, u1);
  errors.tau_compression = tau_c_error;
  errors.stuck = stuck_error;
  errors.before = step_error;
  errors.after = Zero<M>();
  errors.u_compression = Abs(Coarse(second.u)) * stuck_error + Times(5.0, Abs(Coarse(x.compression_end.u)));
  const M works = normal_error + step * errors.v + v1 * step_error +
                  Times(2.0, f_slope * (steps * errors.u + u1 * steps_error)) + Times(8.0, TwiceTotalWork(x));
  errors.works = WithEnergyChange(course, errors, f_path, works);
  errors.decisive = errors.decisive_error = Zero<M>();
  return errors;
}

// Slip stops during restitution.
template <typename N, typename M = CoarseOf<N>>
HWY_INLINE EndErrors<M> StopInRestitutionErrors(const Course<N>& course) {
  const RestitutionLaw law = course.law;
  const Solution<N>& x = course.x;
  const Slopes<N>& second = course.path.second;
  const M slope = Coarse(second.v);
  const M f_slope = Abs(Coarse(second.f));
  const M f_first = Abs(Coarse(course.path.first.f));
  const M before = Coarse(x.rebound.before);
  const M after = Coarse(x.rebound.after);
  const M v_stop = Coarse(course.path.v_stop);
  const M v1 = Coarse(x.end.v);
  const M u1 = Abs(Coarse(x.end.u));
  const M tau = Coarse(x.end.tau);
  const M v_stop_error = StopError(course);
  const M before_error = v_stop_error / Coarse(course.path.first.v) + Times(2.0, before);
  EndErrors<M> errors;
  M after_error;
  if (law == RestitutionLaw::kNewton) {
    after_error = (v_stop_error + v1) / slope + Times(6.0, after);
    errors.v = v1;
  } else if (law == RestitutionLaw::kPoisson) {
    after_error = before_error + Times(3.0, before) + Times(4.0, after);
    errors.v = v_stop_error + slope * (after_error + Times(5.0, after)) + v1;
  } else {
    const M sum = v1 + v_stop;
    const M per_sum = Inverse(sum);
    const M beyond_error = Times(6.0, after * sum) + before * (Times(8.0, v_stop) + Times(2.0, v_stop_error));
    errors.v = v_stop_error + slope * beyond_error * per_sum + Times(4.5, v1);
    after_error = (beyond_error + after * (errors.v + v_stop_error)) * per_sum + Times(2.0, after);
  }
  const M f_path = f_first * Coarse(x.stop.tau) + f_slope * after;
  errors.tau = Times(2.0, Coarse(x.compression_end.tau)) + before_error + after_error + Times(2.0, tau);
  errors.f = f_first * before_error + f_slope * after_error + Times(5.0, f_path);
  errors.u = Abs(Coarse(second.u)) * after_error + Times(4.0, u1);
  const M u_c = Abs(Coarse(x.compression_end.u));
  errors.tau_compression = Times(2.0, Coarse(x.compression_end.tau));
  errors.stuck = Zero<M>();
  errors.before = before_error;
  errors.after = after_error;
  errors.u_compression = UCompressionError(course);
  const M works = before * v_stop_error + before_error * (v_stop + f_first * u_c) + after * (v_stop_error + errors.v) +
                  (v_stop + v1) * after_error + f_slope * (after * errors.u + u1 * after_error) +
                  Times(10.0, TwiceTotalWork(x));
  errors.works = WithEnergyChange(course, errors, f_path, works);
  errors.decisive = after;
  errors.decisive_error = after_error;
  return errors;
}

template <typename N, typename M = CoarseOf<N>>
HWY_INLINE EndErrors<M> ErrorsOf(const Course<N>& course) {
  const MaskOf<N>& early = course.x.stops_in_compression;
  const MaskOf<N> late = Both(course.x.stops_in_restitution, IsPositive(course.x.end.v));
  if (InAllLanes(early)) return StopInCompressionErrors(course);
  if (InAllLanes(late)) return StopInRestitutionErrors(course);
  EndErrors<M> errors = OnePieceErrors(course);
  if (!InNoLane(early)) errors = SelectErrors(early, StopInCompressionErrors(course), errors);
  if (!InNoLane(late)) errors = SelectErrors(late, StopInRestitutionErrors(course), errors);
  return errors;
}

// True if the sign of `value` is that of the exact number.
template <typename V>
HWY_INLINE MaskOf<Plain<V>> IsSure(const Plain<V>& value, const Plain<V>& error) {
  using ricochet::HWY_NAMESPACE::Absolute;
  return Fill<Plain<V>>(kSure * 0x1p-53) * error.value <= Absolute(value.value);
}

// True if every sign that decided on the path is that of the exact number. The sign of a slope, and of mu_s Wtt -
// |Wtn|, is exact, because one operation gives it.
template <typename V>
HWY_INLINE MaskOf<Plain<V>> PathIsSure(const Course<Plain<V>>& course, const EndErrors<Plain<V>>& errors) {
  const Inputs<Plain<V>>& in = course.in;
  const Plain<V> square = Times(kRankTolerance, in.wtt * in.wnn);
  const auto rank_is_sure = IsSure(Abs(in.det) - square, Times(4.0, square));
  const auto stop_is_sure = Either(Not(course.path.stops), IsSure(course.path.v_stop, StopError(course)));
  return Both(rank_is_sure, Both(stop_is_sure, IsSure(errors.decisive, errors.decisive_error)));
}

// True if it is proved that the impact keeps its limits because no law asks for more than was stored: on a path of one
// piece the three laws agree.
template <typename V>
HWY_INLINE MaskOf<Plain<V>> KeepsLimits(const Course<Plain<V>>& course) {
  const auto modest = Rounded(course.in.coefficient) <= Fill<Plain<V>>(1.0);
  if (course.law == RestitutionLaw::kEnergetic) return modest;
  return Both(modest, Not(Either(course.x.stops_in_compression, course.x.stops_in_restitution)));
}

// True if the signs are sure that tell whether the impact keeps its limits.
template <typename V>
HWY_INLINE MaskOf<Plain<V>> LimitsAreSure(const Course<Plain<V>>& course, const EndErrors<Plain<V>>& errors) {
  const Solution<Plain<V>>& x = course.x;
  const Plain<V> error = Times(2.0, errors.works);
  return Both(IsSure(TwiceEnergyChange(course.in, x.end), error),
              IsSure(x.restitution.normal + x.compression.normal, error));
}

template <typename N, typename M = CoarseOf<N>>
HWY_INLINE M SpeedBefore(const Inputs<N>& in) {
  return Larger(Abs(Coarse(in.stated_u0)), Abs(Coarse(in.v0)));
}

// The members of RoundingErrors.
template <typename V>
struct Bounds {
  V velocity, impulse, work, counted_impulse;

  HWY_INLINE V Largest() const {
    using ricochet::HWY_NAMESPACE::Larger;
    return Larger(Larger(velocity, counted_impulse), work);
  }
};

HWY_INLINE RoundingErrors ToErrors(const Bounds<double>& bounds) {
  return {.velocity = bounds.velocity,
          .impulse = bounds.impulse,
          .work = bounds.work,
          .counted_impulse = bounds.counted_impulse};
}

template <typename V>
HWY_INLINE Bounds<V> PlainBounds(const Course<Plain<V>>& course, const EndErrors<Plain<V>>& errors) {
  const V rounding = Fill<Plain<V>>(0x1p-53 * kHigherOrders);
  const V unit = rounding / SpeedBefore(course.in).value;
  const V impulse = unit * Larger(course.in.wnn * errors.tau, course.in.wtt * errors.f).value;
  return {.velocity = unit * Larger(errors.u, errors.v).value,
          .impulse = impulse,
          .work = rounding * (errors.works * Inverse(TwiceTotalWork(course.x))).value,
          .counted_impulse = impulse};
}

// The error of rounding `x` to a double, enlarged by 2^-10 for the rounding of the bound. It is at most half of the
// smallest double where the result is subnormal.
template <typename M>
HWY_INLINE M FinalRounding(const M& x) {
  return Times(0x1p-53 * (1.0 + 0x1p-10), x) + M::Constant(0x1p-1074);
}

// A bound as a double, which is not 0 where it underflows.
template <typename M>
HWY_INLINE RoundedOf<M> OutBound(const M& bound) {
  return Rounded(bound) + Fill<M>(0x1p-1074);
}

// The errors of a compensated path after its numbers have been rounded to doubles. A change of energy below 2^-96 of
// its terms has been replaced by 0.
template <typename N, typename M = CoarseOf<N>>
HWY_INLINE Bounds<RoundedOf<M>> CompensatedBounds(const Course<N>& course, const EndErrors<M>& errors) {
  const Inputs<N>& in = course.in;
  const Solution<N>& x = course.x;
  const M rounding = M::Constant(0x1p-102 * kHigherOrders);
  const M wtt = Coarse(in.wtt);
  const M wnn = Coarse(in.wnn);
  const M tau = Coarse(x.end.tau);
  const M f = Abs(Coarse(x.end.f));
  const M u1 = Abs(Coarse(x.end.u));
  const M v1 = Coarse(x.end.v);
  const M largest_f = Larger(Abs(Coarse(x.compression_end.f)), f);
  const M terms = f * (Times(2.0, Abs(Coarse(in.u0))) + u1) + tau * (v1 - Times(2.0, Coarse(in.v0)));
  const M velocity = rounding * Larger(errors.u, errors.v) + FinalRounding(Larger(u1, v1));
  const M impulse = rounding * Larger(wnn * errors.tau, wtt * errors.f) +
                    Larger(wnn * FinalRounding(tau), wtt * FinalRounding(largest_f));
  const M moved = TwiceTotalWork(x);
  const M work = rounding * errors.works + FinalRounding(moved) + Times(0x1p-95, terms);
  const M speed = SpeedBefore(in);
  const M per_speed = Inverse(speed);
  return {.velocity = OutBound(velocity * per_speed),
          .impulse = OutBound(impulse * per_speed),
          .work = OutBound(work / moved),
          .counted_impulse = OutBound(impulse / Larger(speed, Larger(wnn * tau, wtt * largest_f)))};
}

// Twice the errors of the works of one phase, piece by piece.
template <typename M>
struct TwiceWorkErrors {
  M normal, tangential;

  // Adds a piece with the slope `f` of the friction impulse over `step`, the sums of u and of v at its ends, and the
  // sums of their errors.
  void Add(const M& f, const M& step, const M& step_error, const M& u_sum, const M& u_error, const M& v_sum,
           const M& v_error) {
    const M size = Abs(f);
    const M u_size = Abs(u_sum);
    const M v_size = Abs(v_sum);
    normal = normal + step_error * v_size + step * (v_error + Times(4.0, v_size));
    tangential = tangential + size * (step_error * u_size + step * (u_error + Times(7.0, u_size)));
  }
};

template <typename N, typename M = CoarseOf<N>>
TwiceWorkErrors<M> CompressionWorkErrors(const Course<N>& course, const EndErrors<M>& errors) {
  const Solution<N>& x = course.x;
  const Path<N>& path = course.path;
  const M u0 = Coarse(course.in.u0);
  const M v0 = Coarse(course.in.v0);
  const M u_c = Coarse(x.compression_end.u);
  const M u0_error = Select(course.in.u_follows_v, Times(2.0, Abs(u0)), Zero<M>());
  const M first = Coarse(path.first.f);
  TwiceWorkErrors<M> works = {Zero<M>(), Zero<M>()};
  if (x.stops_in_compression) {
    const M stop = Coarse(x.stop.tau);
    const M v_stop = Coarse(path.v_stop);
    const M v_stop_error = StopError(course);
    works.Add(first, stop, Times(2.0, stop), u0, u0_error, v0 + v_stop, v_stop_error);
    works.Add(Coarse(path.second.f), Coarse(x.stuck_compression), errors.stuck, u_c, errors.u_compression, v_stop,
              v_stop_error);
  } else {
    const M tau = Coarse(x.compression_end.tau);
    works.Add(first, tau, Times(2.0, tau), u0 + u_c, u0_error + errors.u_compression, v0, Zero<M>());
  }
  return works;
}

template <typename N, typename M = CoarseOf<N>>
TwiceWorkErrors<M> RestitutionWorkErrors(const Course<N>& course, const EndErrors<M>& errors) {
  const Solution<N>& x = course.x;
  const Path<N>& path = course.path;
  TwiceWorkErrors<M> works = {Zero<M>(), Zero<M>()};
  if (course.held) return works;
  const M u_c = Coarse(x.compression_end.u);
  const M u1 = Coarse(x.end.u);
  const M v1 = Coarse(x.end.v);
  const M before = Coarse(x.rebound.before);
  if (x.stops_in_restitution) {
    const M v_stop = Coarse(path.v_stop);
    const M v_stop_error = StopError(course);
    works.Add(Coarse(path.first.f), before, errors.before, u_c, errors.u_compression, v_stop, v_stop_error);
    works.Add(Coarse(path.second.f), Coarse(x.rebound.after), errors.after, u1, errors.u, v_stop + v1,
              v_stop_error + errors.v);
  } else {
    const M f = Coarse(x.stops_in_compression ? path.second.f : path.first.f);
    works.Add(f, before, errors.before, u_c + u1, errors.u_compression + errors.u, v1, errors.v);
  }
  return works;
}

// The errors of all numbers of one impact, each on its own scale. A compensated path errs by 2^-102 for every rounding,
// and its numbers are then rounded to doubles.
template <typename N, typename M = CoarseOf<N>>
ImpactErrors NumberErrorsOf(const Problem& problem, const Course<N>& course, const EndErrors<M>& errors,
                            const Impact& impact) {
  const Solution<N>& x = course.x;
  const M unit = M::Constant((N::kCompensated ? 0x1p-102 : 0x1p-53) * kHigherOrders);
  const M half_unit = Times(0.5, unit);
  const auto out = [](const M& error, double number) {
    const M final = N::kCompensated ? FinalRounding(Abs(M::Constant(number))) : Zero<M>();
    return OutBound(error + final);
  };
  const TwiceWorkErrors<M> compression = CompressionWorkErrors(course, errors);
  const TwiceWorkErrors<M> restitution = RestitutionWorkErrors(course, errors);
  const M tau_c = Coarse(x.compression_end.tau);
  const M tau = Coarse(x.end.tau);
  const M work_c = Times(-0.5, Coarse(x.compression.normal));
  const M f = Abs(Coarse(x.end.f));
  const M terms = f * (Times(2.0, Abs(Coarse(course.in.u0))) + Abs(Coarse(x.end.u))) +
                  tau * (Coarse(x.end.v) - Times(2.0, Coarse(course.in.v0)));
  // Coefficients are quotients of the numbers of the path, and not of doubles.
  const M per_tau = Inverse(tau_c);
  const M per_work = Inverse(work_c);
  ImpactEnd<double> scaled = impact;
  scaled.tau_compression = 1.0;
  scaled.tau1 = Rounded(tau * per_tau);
  scaled.work_normal_compression = -1.0;
  ImpactErrors numbers;
  numbers.v = OutBound(unit * errors.v / -Coarse(course.in.v0));
  numbers.tau_compression = OutBound(unit * errors.tau_compression * per_tau);
  numbers.tau = OutBound(unit * errors.tau * per_tau);
  numbers.f = OutBound(unit * errors.f * per_tau);
  numbers.work_normal_compression = OutBound(half_unit * compression.normal * per_work);
  numbers.work_normal_restitution = OutBound(half_unit * restitution.normal * per_work);
  SetCoefficientErrors(scaled, -1.0, problem.law, problem.coefficient, numbers);
  numbers.u = out(unit * errors.u, impact.u1);
  numbers.v = out(unit * errors.v, impact.v1);
  numbers.tau_compression = out(unit * errors.tau_compression, impact.tau_compression);
  numbers.tau = out(unit * errors.tau, impact.tau1);
  numbers.f = out(unit * errors.f, impact.f1);
  numbers.work_normal_compression = out(half_unit * compression.normal, impact.work_normal_compression);
  numbers.work_normal_restitution = out(half_unit * restitution.normal, impact.work_normal_restitution);
  numbers.work_tangential_compression = out(half_unit * compression.tangential, impact.work_tangential_compression);
  numbers.work_tangential_restitution = out(half_unit * restitution.tangential, impact.work_tangential_restitution);
  const M cut = N::kCompensated ? Times(0x1p-96, terms) : Zero<M>();
  numbers.energy_change = out(half_unit * errors.works + cut, impact.energy_change);
  return numbers;
}

}  // namespace ricochet::planar::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
