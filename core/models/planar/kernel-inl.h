// The path of a planar impact (core/models/planar/planar.h) over a number type N: DoubleDouble for moderate inputs,
// Wide for all, and Plain where a rounding error within the bound of core/models/planar/rounding-inl.h serves.
//
// N holds a number, or a SIMD vector with one problem in each lane. Every course is then computed that some lane takes,
// and masks choose; no lane depends on another, so that an impact has the same bits in a vector and alone.
//
// A path has at most two pieces: the first slip, and the piece after slip has stopped. Slopes are sums of a number and
// an exact product, right to 3 u^2 (u = 2^-53), or to u in plain arithmetic, and their signs are exact. The only
// difference that may cancel is d = v0 u' - u0 v'; its sign decides whether slip stops or compression ends first. Every
// work is a sum of terms of one sign. docs/theory/planar_numerics.md says more.

// Per-target include guard.
#if defined(RICOCHET_CORE_MODELS_PLANAR_KERNEL_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef RICOCHET_CORE_MODELS_PLANAR_KERNEL_INL_H_
#undef RICOCHET_CORE_MODELS_PLANAR_KERNEL_INL_H_
#else
#define RICOCHET_CORE_MODELS_PLANAR_KERNEL_INL_H_
#endif

#include <array>
#include <cstddef>

#include "core/models/planar/planar.h"
#include "core/models/restitution_law.h"
#include "core/numerics/double_double-inl.h"
#include "core/numerics/plain-inl.h"

HWY_BEFORE_NAMESPACE();
namespace ricochet::planar::HWY_NAMESPACE {

using ricochet::HWY_NAMESPACE::Both;
using ricochet::HWY_NAMESPACE::Either;
using ricochet::HWY_NAMESPACE::InAllLanes;
using ricochet::HWY_NAMESPACE::InNoLane;
using ricochet::HWY_NAMESPACE::Not;
using ricochet::HWY_NAMESPACE::Plain;
using ricochet::HWY_NAMESPACE::Select;
using ricochet::HWY_NAMESPACE::SelectMask;

// One truth value for each problem: a bool, or a mask if N holds a vector.
template <typename N>
using MaskOf = decltype(IsNegative(N()));

template <typename N>
struct Inputs {
  N wtt, wtn, wnn, u0, v0, mu, mu_static, coefficient;
  N stated_u0;  // u0 before RankOnePath replaces it.
  N det;
  MaskOf<N> rank_one;
  MaskOf<N> u_follows_v;  // W has rank one and (u0, v0) lies in its range, so that u and v vanish together.
};

// d(u, v, f)/dtau.
template <typename N>
struct Slopes {
  N u, v, f;
};

// Members that are said not to be set may hold anything, infinities and NaN included.
template <typename N>
struct Path {
  Slopes<N> first;   // Slopes of the first slip; not set if u0 = 0.
  Slopes<N> second;  // Slopes after slip has stopped; not set if it never stops.
  MaskOf<N> slips_first;
  MaskOf<N> stops;      // Slip stops if the impact lasts long enough; true if u0 = 0.
  MaskOf<N> sticks;     // Not set if slip never stops.
  N v_stop;             // v where slip stops.
  N u_compression_end;  // u where v = 0, if slip has not stopped before.
};

// The contact at one instant.
template <typename N>
struct State {
  N tau, f, u, v;
};

template <typename N>
struct TwiceWork {
  N normal, tangential;
};

// The course and the end of restitution.
template <typename N>
struct Rebound {
  MaskOf<N> passes_stop;  // True if slip stops during restitution.
  N before, after;        // Normal impulses before and after slip stops; if it does not stop, `before` is all of it.
  N v1;
};

template <typename N>
struct Solution {
  State<N> stop;  // Not set if slip does not stop.
  State<N> compression_end, end;
  TwiceWork<N> compression, restitution;
  N stuck_compression;  // Normal impulse from the stop of slip to the end of compression, if slip stops before.
  Rebound<N> rebound;   // Not set if the contact is locked.
  MaskOf<N> stops_in_compression;
  MaskOf<N> stops_in_restitution;
};

// The whole impact.
template <typename N>
struct Course {
  RestitutionLaw law;
  Inputs<N> in;
  Path<N> path;
  Solution<N> x;
  MaskOf<N> held;    // No further impulse moves the contact where slip has stopped: it is locked, or it has jammed.
  MaskOf<N> jammed;  // It is held with a v that does not end the impact.
};

template <typename N>
HWY_INLINE N Zero() {
  return N::Constant(0.0);
}

template <typename N>
HWY_INLINE N Abs(const N& x) {
  return Select(IsNegative(x), -x, x);
}

template <typename V>
HWY_INLINE Plain<V> Abs(const Plain<V>& x) {
  return Plain<V>(ricochet::HWY_NAMESPACE::Absolute(x.value));
}

// Returns a b - c d.
template <typename N>
HWY_INLINE N DifferenceOfProducts(const N& a, const N& b, const N& c, const N& d) {
  return a * b - c * d;
}
// The result is right to 2 u (Jeannerod, Louvet and Muller, 2013).
template <typename V>
HWY_INLINE Plain<V> DifferenceOfProducts(const Plain<V>& a, const Plain<V>& b, const Plain<V>& c, const Plain<V>& d) {
  using ricochet::HWY_NAMESPACE::FmaSubtract;
  using ricochet::HWY_NAMESPACE::NegativeFma;
  const V product = c.value * d.value;
  return Plain<V>(FmaSubtract(a.value, b.value, product) + NegativeFma(c.value, d.value, product));
}

// Returns -x where `negative` is true, and x elsewhere.
template <typename N>
HWY_INLINE N Signed(const N& x, const MaskOf<N>& negative) {
  return Select(negative, -x, x);
}

template <typename N>
HWY_INLINE Slopes<N> SelectSlopes(const MaskOf<N>& condition, const Slopes<N>& yes, const Slopes<N>& no) {
  return {Select(condition, yes.u, no.u), Select(condition, yes.v, no.v), Select(condition, yes.f, no.f)};
}

template <typename N>
HWY_INLINE State<N> SelectState(const MaskOf<N>& condition, const State<N>& yes, const State<N>& no) {
  return {Select(condition, yes.tau, no.tau), Select(condition, yes.f, no.f), Select(condition, yes.u, no.u),
          Select(condition, yes.v, no.v)};
}

template <typename N>
HWY_INLINE TwiceWork<N> SelectWork(const MaskOf<N>& condition, const TwiceWork<N>& yes, const TwiceWork<N>& no) {
  return {Select(condition, yes.normal, no.normal), Select(condition, yes.tangential, no.tangential)};
}

// The inputs whose k-th number, in the order of `Inputs`, is number(k).
template <typename N, typename Number>
HWY_INLINE Inputs<N> InputsFrom(const Number& number) {
  Inputs<N> in;
  in.wtt = number(0);
  in.wtn = number(1);
  in.wnn = number(2);
  in.u0 = in.stated_u0 = number(3);
  in.v0 = number(4);
  in.mu = number(5);
  in.mu_static = number(6);
  in.coefficient = number(7);
  const N square = in.wtt * in.wnn;
  in.det = DifferenceOfProducts(in.wtt, in.wnn, in.wtn, in.wtn);
  in.rank_one = Not(IsPositive(Abs(in.det) - N::Constant(kRankTolerance) * square));
  in.u_follows_v = in.rank_one;
  return in;
}

// The numbers of a problem or of a direction of it (core/models/planar/tangent.h), in the order of `Inputs`.
template <typename Numbers>
HWY_INLINE std::array<double, 8> AsArray(const Numbers& x) {
  return {x.w.tt, x.w.tn, x.w.nn, x.u0, x.v0, x.mu, x.mu_static, x.coefficient};
}

template <typename N>
HWY_INLINE Inputs<N> MakeInputs(const Problem& problem) {
  const std::array<double, 8> numbers = AsArray(problem);
  return InputsFrom<N>([&numbers](size_t k) HWY_ATTR { return N::Exactly(numbers[k]); });
}

// The slopes of slip with u < 0 (`backwards`) or u > 0.
template <typename N>
HWY_INLINE Slopes<N> SlipSlopes(const Inputs<N>& in, const MaskOf<N>& backwards) {
  const N f = Signed(in.mu, Not(backwards));
  return {.u = AddProduct(in.wtn, f, in.wtt), .v = AddProduct(in.wnn, f, in.wtn), .f = f};
}

// Returns the slopes of stick where `sticks`, and else those of slip in the direction to which Wtn drives it.
template <typename N>
HWY_INLINE Slopes<N> SlopesAfterStop(const Inputs<N>& in, const MaskOf<N>& sticks) {
  Slopes<N> slopes = {Zero<N>(), Zero<N>(), Zero<N>()};
  if (!InAllLanes(sticks)) slopes = SlipSlopes(in, IsNegative(in.wtn));
  if (InNoLane(sticks)) return slopes;
  const N inverse = Inverse(in.wtt);
  return SelectSlopes(sticks, {.u = Zero<N>(), .v = in.det * inverse, .f = -in.wtn * inverse}, slopes);
}

// A number type that also carries changes has a function of its own, which is false where only the change is negative:
// slip that slows down by the change alone stops at infinity, long after the end.
template <typename N>
HWY_INLINE MaskOf<N> IsNegativeItself(const N& x) {
  return IsNegative(x);
}

template <typename N>
HWY_INLINE Path<N> FullRankPath(const Inputs<N>& in) {
  Path<N> path;
  const MaskOf<N> backwards = IsNegative(in.u0);
  path.slips_first = Either(IsPositive(in.u0), backwards);
  path.first = SlipSlopes(in, backwards);
  path.stops = Either(Not(path.slips_first), IsNegativeItself(Signed(path.first.u, backwards)));
  path.v_stop = in.v0;
  path.u_compression_end = Zero<N>();
  const N d = DifferenceOfProducts(in.v0, path.first.u, in.u0, path.first.v);
  const MaskOf<N> slip_stops = Both(path.slips_first, path.stops);
  if (!InNoLane(slip_stops)) path.v_stop = Select(slip_stops, d / path.first.u, in.v0);
  // If v' <= 0, slip stops before v = 0.
  if (!InNoLane(IsPositive(path.first.v))) path.u_compression_end = -d / path.first.v;
  path.sticks = path.stops;
  path.second = path.first;
  if (InNoLane(path.stops)) return path;
  path.sticks = Not(IsNegative(AddProduct(-Abs(in.wtn), in.mu_static, in.wtt)));
  path.second = SlopesAfterStop(in, path.sticks);
  return path;
}

// The slopes of slip for a W of rank one, which moves u by Wtn/Wnn of what it moves v by.
template <typename N>
HWY_INLINE Slopes<N> RankOneSlopes(const Inputs<N>& in, const MaskOf<N>& backwards, const N& ratio) {
  Slopes<N> slopes = SlipSlopes(in, backwards);
  slopes.u = slopes.v * ratio;
  return slopes;
}

// The path for a W of rank one, which moves the contact in one direction only. A velocity in the range of W lies along
// it: u = v Wtn/Wnn throughout, and u0 is replaced accordingly. Any other velocity keeps its part beside that
// direction, and v stands still where the contact sticks. If Wtt = 0, u stands still.
template <typename N>
HWY_INLINE Path<N> RankOnePath(Inputs<N>& in) {
  // Plain arithmetic takes a velocity into the range only if the exact difference lies within the tolerance, too. One
  // that it takes out wrongly has a v_stop whose sign it cannot prove.
  constexpr double kTolerance = N::kCompensated ? kRangeTolerance : (1.0 - 0x1p-40) * kRangeTolerance;
  Path<N> path;
  const N ratio = in.wtn / in.wnn;
  const N beside = DifferenceOfProducts(in.u0, in.wnn, in.v0, in.wtn);
  const N size = Abs(in.u0) * in.wnn + Abs(in.v0 * in.wtn);
  const MaskOf<N> moves = IsPositive(in.wtt);
  const MaskOf<N> follows = Both(moves, Not(IsPositive(Abs(beside) - N::Constant(kTolerance) * size)));
  in.u_follows_v = follows;
  in.u0 = Select(follows, in.v0 * ratio, in.u0);
  const MaskOf<N> backwards = SelectMask(follows, IsPositive(in.wtn), IsNegative(in.u0));
  const MaskOf<N> slips = Either(IsPositive(in.u0), IsNegative(in.u0));
  path.first = RankOneSlopes(in, backwards, ratio);
  path.first.f = Select(Either(moves, slips), path.first.f, Zero<N>());
  path.slips_first = Either(follows, Either(slips, Not(moves)));
  // Where v' <= 0, slip stops or stands still, and v stays below 0.
  const MaskOf<N> stops = Either(IsNegative(Signed(path.first.u, backwards)), Not(IsPositive(path.first.v)));
  path.stops = Both(moves, Either(follows, Either(stops, Not(path.slips_first))));
  path.v_stop = Select(Both(path.slips_first, moves), Select(follows, Zero<N>(), -beside / in.wtn), in.v0);
  path.u_compression_end = Select(moves, Select(follows, Zero<N>(), beside / in.wnn), in.u0);
  path.sticks = Not(IsNegative(AddProduct(-in.wnn, in.mu_static, Abs(in.wtn))));
  path.second = RankOneSlopes(in, IsNegative(in.wtn), ratio);
  const Slopes<N> stick = {.u = Zero<N>(), .v = Zero<N>(), .f = -in.wnn / in.wtn};
  path.second = SelectSlopes(path.sticks, stick, path.second);
  return path;
}

template <typename N>
HWY_INLINE Path<N> SelectPath(const MaskOf<N>& condition, const Path<N>& yes, const Path<N>& no) {
  Path<N> path;
  path.first = SelectSlopes(condition, yes.first, no.first);
  path.second = SelectSlopes(condition, yes.second, no.second);
  path.slips_first = SelectMask(condition, yes.slips_first, no.slips_first);
  path.stops = SelectMask(condition, yes.stops, no.stops);
  path.sticks = SelectMask(condition, yes.sticks, no.sticks);
  path.v_stop = Select(condition, yes.v_stop, no.v_stop);
  path.u_compression_end = Select(condition, yes.u_compression_end, no.u_compression_end);
  return path;
}

template <typename N>
HWY_INLINE Path<N> MakePath(Inputs<N>& in) {
  if (InNoLane(in.rank_one)) return FullRankPath(in);
  Inputs<N> moved = in;
  const Path<N> path = RankOnePath(moved);
  in.u_follows_v = Both(in.rank_one, moved.u_follows_v);
  if (InAllLanes(in.rank_one)) {
    in.u0 = moved.u0;
    return path;
  }
  const Path<N> full = FullRankPath(in);
  in.u0 = Select(in.rank_one, moved.u0, in.u0);
  return SelectPath(in.rank_one, path, full);
}

// Advances along one piece to (u, v). The caller knows these velocities more accurately than a sum would give them.
template <typename N>
HWY_INLINE void Advance(const Slopes<N>& slopes, const N& step, const N& u, const N& v, State<N>& at,
                        TwiceWork<N>& work) {
  const N f_step = slopes.f * step;
  work.normal = work.normal + step * (at.v + v);
  work.tangential = work.tangential + f_step * (at.u + u);
  at = {at.tau + step, at.f + f_step, u, v};
}

// Advances along the first piece of a phase, before which no work of the phase has been done.
template <typename N>
HWY_INLINE void Begin(const Slopes<N>& slopes, const N& step, const N& u, const N& v, State<N>& at,
                      TwiceWork<N>& work) {
  const N f_step = slopes.f * step;
  work = {step * (at.v + v), f_step * (at.u + u)};
  at = {at.tau + step, at.f + f_step, u, v};
}

// Advances those problems alone that `advances` says. The others may hold anything in the arguments.
template <typename N>
HWY_INLINE void AdvanceSome(const MaskOf<N>& advances, const Slopes<N>& slopes, const N& step, const N& u, const N& v,
                            State<N>& at, TwiceWork<N>& work) {
  State<N> then = at;
  TwiceWork<N> then_work = work;
  Advance(slopes, step, u, v, then, then_work);
  at = SelectState(advances, then, at);
  work = SelectWork(advances, then_work, work);
}

template <typename N>
HWY_INLINE void Compress(const Inputs<N>& in, const Path<N>& path, Solution<N>& x) {
  const MaskOf<N> stops = Both(path.stops, IsNegative(path.v_stop));
  State<N> at = {Zero<N>(), Zero<N>(), in.u0, in.v0};
  N step = Select(stops, -in.u0, -in.v0) / Select(stops, path.first.u, path.first.v);
  step = Select(path.slips_first, step, Zero<N>());
  Begin(path.first, step, Select(stops, Zero<N>(), path.u_compression_end), Select(stops, path.v_stop, Zero<N>()), at,
        x.compression);
  x.stop = at;
  x.stops_in_compression = stops;
  x.stuck_compression = Zero<N>();
  if (!InNoLane(stops)) {
    x.stuck_compression = -path.v_stop / path.second.v;
    AdvanceSome(stops, path.second, x.stuck_compression, path.second.u * x.stuck_compression, Zero<N>(), at,
                x.compression);
  }
  x.compression_end = at;
}

// `stop_ahead` is true if slip has not stopped yet but will at path.v_stop.
template <typename N>
HWY_INLINE Rebound<N> FindNewton(const Inputs<N>& in, const Path<N>& path, const N& slope,
                                 const MaskOf<N>& stop_ahead) {
  const N v1 = -in.coefficient * in.v0;
  if (InNoLane(stop_ahead)) return {stop_ahead, v1 / slope, Zero<N>(), v1};
  const N beyond = v1 - path.v_stop;
  const MaskOf<N> passes = Both(stop_ahead, Not(IsNegative(beyond)));
  N after = Zero<N>();
  if (!InNoLane(passes)) after = Select(passes, beyond / path.second.v, after);
  return {passes, Select(passes, path.v_stop, v1) / slope, after, v1};
}

template <typename N>
HWY_INLINE Rebound<N> FindPoisson(const Inputs<N>& in, const Path<N>& path, const N& tau_c, const N& slope,
                                  const MaskOf<N>& stop_ahead) {
  const N step = in.coefficient * tau_c;
  const N v1 = slope * step;
  if (InNoLane(stop_ahead)) return {stop_ahead, step, Zero<N>(), v1};
  const N before = path.v_stop / slope;
  const N after = step - before;
  const MaskOf<N> passes = Both(stop_ahead, Not(IsNegative(after)));
  return {passes, Select(passes, before, step), Select(passes, after, Zero<N>()),
          Select(passes, path.v_stop + path.second.v * after, v1)};
}

// On a piece v^2 changes by twice the slope of v times the work; the impulse is that change over the sum of both v.
template <typename N>
HWY_INLINE Rebound<N> FindEnergetic(const Inputs<N>& in, const Path<N>& path, const N& stored_twice, const N& slope,
                                    const MaskOf<N>& stop_ahead) {
  const N work = in.coefficient * in.coefficient * stored_twice;
  N square = slope * work;
  MaskOf<N> passes = stop_ahead;
  N before = Zero<N>();
  N beyond = Zero<N>();
  if (!InNoLane(stop_ahead)) {
    before = path.v_stop / slope;
    beyond = work - path.v_stop * before;
    passes = Both(stop_ahead, Not(IsNegative(beyond)));
    square = Select(passes, path.v_stop * path.v_stop + path.second.v * beyond, square);
  }
  const N v1 = Sqrt(square);
  N after = Zero<N>();
  if (!InNoLane(passes)) after = Select(passes, beyond / (v1 + path.v_stop), after);
  if (!InAllLanes(passes)) before = Select(passes, before, v1 / slope);
  return {passes, before, after, v1};
}

template <typename N>
HWY_INLINE Rebound<N> FindSome(RestitutionLaw law, const Inputs<N>& in, const Path<N>& path, const Solution<N>& x,
                               const N& slope, const MaskOf<N>& stop_ahead) {
  switch (law) {
    case RestitutionLaw::kNewton:
      return FindNewton(in, path, slope, stop_ahead);
    case RestitutionLaw::kPoisson:
      return FindPoisson(in, path, x.compression_end.tau, slope, stop_ahead);
    case RestitutionLaw::kEnergetic:
      break;
  }
  return FindEnergetic(in, path, -x.compression.normal, slope, stop_ahead);
}

template <typename N>
HWY_INLINE Rebound<N> FindRebound(RestitutionLaw law, const Inputs<N>& in, const Path<N>& path, const Solution<N>& x,
                                  const N& slope, const MaskOf<N>& stop_ahead) {
  const MaskOf<N> restores = IsPositive(in.coefficient);
  const Rebound<N> none = {Both(stop_ahead, Not(IsPositive(path.v_stop))), Zero<N>(), Zero<N>(), Zero<N>()};
  if (InNoLane(restores)) return none;
  const Rebound<N> some = FindSome(law, in, path, x, slope, stop_ahead);
  if (InAllLanes(restores)) return some;
  return {SelectMask(restores, some.passes_stop, none.passes_stop), Select(restores, some.before, none.before),
          Select(restores, some.after, none.after), Select(restores, some.v1, none.v1)};
}

template <typename N>
HWY_INLINE void Restore(RestitutionLaw law, const Inputs<N>& in, const Path<N>& path, Solution<N>& x) {
  State<N> at = x.compression_end;
  const Slopes<N> slopes = SelectSlopes(x.stops_in_compression, path.second, path.first);
  const MaskOf<N> stop_ahead = Both(path.stops, Not(x.stops_in_compression));
  x.rebound = FindRebound(law, in, path, x, slopes.v, stop_ahead);
  const Rebound<N>& rebound = x.rebound;
  const MaskOf<N>& passes = rebound.passes_stop;
  x.stops_in_restitution = passes;
  N u = at.u + slopes.u * rebound.before;
  // Slip that has not stopped has not reversed; a u of the other sign is rounding.
  const MaskOf<N> is_rounding = Both(stop_ahead, IsNegative(Signed(u, IsNegative(at.u))));
  u = Select(Either(passes, is_rounding), Zero<N>(), u);
  Begin(slopes, rebound.before, u, Select(passes, path.v_stop, rebound.v1), at, x.restitution);
  if (!InNoLane(passes)) {
    x.stop = SelectState(passes, at, x.stop);
    AdvanceSome(passes, path.second, rebound.after, path.second.u * rebound.after, rebound.v1, at, x.restitution);
  }
  x.end = at;
}

// A locked contact stays where compression has brought it.
template <typename N>
HWY_INLINE void Lock(const MaskOf<N>& locked, Solution<N>& x) {
  x.stops_in_restitution = Both(x.stops_in_restitution, Not(locked));
  x.restitution = SelectWork(locked, {Zero<N>(), Zero<N>()}, x.restitution);
  x.stop = SelectState(locked, x.compression_end, x.stop);
  x.end = SelectState(locked, x.compression_end, x.end);
}

// A contact that halts stays where slip has stopped. With v' = 0 slip never stops, and it stays where it was.
template <typename N>
HWY_INLINE void Halt(const MaskOf<N>& halts, const Inputs<N>& in, const Path<N>& path, Solution<N>& x) {
  const N zero = Zero<N>();
  const MaskOf<N> in_compression = Both(halts, IsNegative(path.v_stop));
  const MaskOf<N> reaches_stop = Both(path.slips_first, Either(IsPositive(path.first.v), IsNegative(path.first.v)));
  State<N> at = {zero, zero, in.u0, in.v0};
  TwiceWork<N> work;
  Begin(path.first, Select(reaches_stop, -in.u0 / path.first.u, zero), Select(reaches_stop, zero, in.u0),
        Select(reaches_stop, path.v_stop, in.v0), at, work);
  x.compression_end = SelectState(in_compression, at, x.compression_end);
  x.compression = SelectWork(in_compression, work, x.compression);
  x.stop = SelectState(in_compression, at, x.stop);
  x.end = SelectState(halts, x.stop, x.end);
  at = x.compression_end;
  Begin(path.first, path.v_stop / path.first.v, zero, path.v_stop, at, work);
  x.restitution = SelectWork(halts, work, x.restitution);
  x.restitution = SelectWork(in_compression, {zero, zero}, x.restitution);
  x.rebound.after = Select(halts, zero, x.rebound.after);
  x.stops_in_compression = Either(x.stops_in_compression, in_compression);
  x.stops_in_restitution = Both(x.stops_in_restitution, Not(in_compression));
}

// Ends a course on which W has rank one and some contacts stick. Those whose velocity does not lie in the range of W
// stick with a v that no impulse changes: they jam if it is below 0, or below what Newton's law asks for.
template <typename N>
HWY_INLINE void EndStuck(const MaskOf<N>& stuck, Course<N>& course) {
  const MaskOf<N> locked = Both(stuck, course.in.u_follows_v);
  if (InAllLanes(locked)) {
    course.x.stops_in_restitution = Not(locked);
  } else {
    Restore(course.law, course.in, course.path, course.x);
  }
  if (!InNoLane(locked)) Lock(locked, course.x);
  const N& v_stop = course.path.v_stop;
  MaskOf<N> halts = IsNegative(v_stop);
  MaskOf<N> jams = halts;
  if (course.law == RestitutionLaw::kNewton) {
    const N missing = -course.in.coefficient * course.in.v0 - v_stop;
    halts = Either(halts, Not(IsNegative(missing)));
    jams = Either(jams, IsPositive(missing));
  }
  halts = Both(stuck, Both(halts, Not(locked)));
  course.jammed = Both(halts, jams);
  course.held = Either(locked, course.jammed);
  if (InNoLane(halts)) return;
  Halt(halts, course.in, course.path, course.x);
  // This slope changes no impulse any more, but bounds on errors divide by it, so it must not be 0.
  course.path.second.v = Select(halts, course.in.wnn, course.path.second.v);
}

// Follows problems of one law, none of which may be separating.
template <typename N>
HWY_INLINE Course<N> Follow(RestitutionLaw law, const Inputs<N>& in) {
  Course<N> course;
  course.law = law;
  course.in = in;
  course.path = MakePath(course.in);
  Compress(course.in, course.path, course.x);
  course.held = course.jammed = Both(in.rank_one, Both(course.path.stops, course.path.sticks));
  if (InNoLane(course.held)) {
    Restore(law, course.in, course.path, course.x);
  } else {
    EndStuck(course.held, course);
  }
  return course;
}

}  // namespace ricochet::planar::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
