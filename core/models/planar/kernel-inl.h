// The path of a planar impact (core/models/planar/planar.h) over a number type N: DoubleDouble for moderate inputs, Wide for
// all, and Plain where a rounding error within the bound of core/models/planar/rounding-inl.h serves.
//
// A path has at most two pieces: the first slip, and the piece after slip has stopped. Slopes are sums of a number and an
// exact product, right to 3 u^2 (u = 2^-53), or to u in plain arithmetic, and their signs are exact. The only difference
// that may cancel is d = v0 u' - u0 v'; its sign decides whether slip stops or compression ends first. Every work is a sum
// of terms of one sign. docs/theory/planar_numerics.md says more.

// Per-target include guard.
#if defined(RICOCHET_CORE_MODELS_PLANAR_KERNEL_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef RICOCHET_CORE_MODELS_PLANAR_KERNEL_INL_H_
#undef RICOCHET_CORE_MODELS_PLANAR_KERNEL_INL_H_
#else
#define RICOCHET_CORE_MODELS_PLANAR_KERNEL_INL_H_
#endif

#include <cmath>

#include "core/models/planar/planar.h"
#include "core/models/restitution_law.h"
#include "core/numerics/double_double-inl.h"
#include "core/numerics/plain-inl.h"

HWY_BEFORE_NAMESPACE();
namespace ricochet::planar::HWY_NAMESPACE {

using ricochet::HWY_NAMESPACE::Plain;

template <typename N>
struct Inputs {
  N wtt, wtn, wnn, u0, v0, mu, mu_static, coefficient;
  N det;
  bool rank_one;
};

// d(u, v, f)/dtau.
template <typename N>
struct Slopes {
  N u, v, f;
};

template <typename N>
struct Path {
  Slopes<N> first;   // Slopes of the first slip; not set if u0 = 0.
  Slopes<N> second;  // Slopes after slip has stopped; not set if it never stops.
  bool slips_first;
  bool stops;  // Slip stops if the impact lasts long enough; true if u0 = 0.
  bool sticks;
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
  bool passes_stop;  // True if slip stops during restitution.
  N before, after;   // Normal impulses before and after slip stops; if it does not stop, `before` is all of it.
  N v1;
};

template <typename N>
struct Solution {
  State<N> stop, compression_end, end;
  TwiceWork<N> compression, restitution;
  N stuck_compression;  // Normal impulse from the stop of slip to the end of compression, if slip stops before.
  Rebound<N> rebound;   // Not set if the contact is locked.
  bool stops_in_compression;
  bool stops_in_restitution;
};

// The whole impact.
template <typename N>
struct Course {
  Inputs<N> in;
  Path<N> path;
  Solution<N> x;
  bool locked;
};

template <typename N>
HWY_INLINE N Zero() {
  return N::Constant(0.0);
}

template <typename N>
HWY_INLINE N Abs(const N& x) {
  return Select(IsNegative(x), -x, x);
}

HWY_INLINE Plain<double> Abs(const Plain<double>& x) { return Plain<double>(std::fabs(x.value)); }

// a b - c d.
template <typename N>
HWY_INLINE N DifferenceOfProducts(const N& a, const N& b, const N& c, const N& d) {
  return a * b - c * d;
}
// Right to 2 u (Jeannerod, Louvet and Muller, 2013).
HWY_INLINE Plain<double> DifferenceOfProducts(const Plain<double>& a, const Plain<double>& b, const Plain<double>& c,
                                              const Plain<double>& d) {
  using ricochet::HWY_NAMESPACE::FmaSubtract;
  using ricochet::HWY_NAMESPACE::NegativeFma;
  const double product = c.value * d.value;
  return Plain<double>(FmaSubtract(a.value, b.value, product) + NegativeFma(c.value, d.value, product));
}

// x or -x.
template <typename N>
HWY_INLINE N Signed(const N& x, bool negative) {
  return Select(negative, -x, x);
}

template <typename N>
HWY_INLINE Inputs<N> MakeInputs(const Problem& problem) {
  Inputs<N> in = {.wtt = N::Exactly(problem.w.tt),
                  .wtn = N::Exactly(problem.w.tn),
                  .wnn = N::Exactly(problem.w.nn),
                  .u0 = N::Exactly(problem.u0),
                  .v0 = N::Exactly(problem.v0),
                  .mu = N::Exactly(problem.mu),
                  .mu_static = N::Exactly(problem.mu_static),
                  .coefficient = N::Exactly(problem.coefficient),
                  .det = Zero<N>(),
                  .rank_one = false};
  const N square = in.wtt * in.wnn;
  in.det = DifferenceOfProducts(in.wtt, in.wnn, in.wtn, in.wtn);
  in.rank_one = !IsPositive(Abs(in.det) - N::Constant(kRankTolerance) * square);
  return in;
}

// The slopes of slip with u < 0 (`backwards`) or u > 0.
template <typename N>
HWY_INLINE Slopes<N> SlipSlopes(const Inputs<N>& in, bool backwards) {
  const N f = Signed(in.mu, !backwards);
  return {.u = AddProduct(in.wtn, f, in.wtt), .v = AddProduct(in.wnn, f, in.wtn), .f = f};
}

template <typename N>
HWY_INLINE Path<N> FullRankPath(const Inputs<N>& in) {
  Path<N> path;
  path.v_stop = in.v0;
  path.stops = true;
  path.slips_first = IsPositive(in.u0) || IsNegative(in.u0);
  if (path.slips_first) {
    const bool backwards = IsNegative(in.u0);
    path.first = SlipSlopes(in, backwards);
    path.stops = IsNegative(Signed(path.first.u, backwards));
    const N d = DifferenceOfProducts(in.v0, path.first.u, in.u0, path.first.v);
    if (path.stops) path.v_stop = d / path.first.u;
    // If v' <= 0, slip stops before v = 0.
    if (IsPositive(path.first.v)) path.u_compression_end = -d / path.first.v;
  }
  if (!path.stops) return path;
  path.sticks = !IsNegative(AddProduct(-Abs(in.wtn), in.mu_static, in.wtt));
  if (path.sticks) {
    const N inverse = Inverse(in.wtt);
    path.second = {.u = Zero<N>(), .v = in.det * inverse, .f = -in.wtn * inverse};
  } else {
    path.second = SlipSlopes(in, IsNegative(in.wtn));
  }
  return path;
}

// The path for a W of rank one, where u = v Wtn/Wnn throughout; u0 is replaced accordingly. If Wtt = 0, friction has no
// effect on u and the path has one piece.
template <typename N>
HWY_INLINE Path<N> RankOnePath(Inputs<N>& in) {
  Path<N> path;
  path.slips_first = true;
  path.v_stop = Zero<N>();
  path.u_compression_end = Zero<N>();
  path.stops = IsPositive(in.wtt);
  if (!path.stops) {
    path.first = {.u = Zero<N>(), .v = in.wnn, .f = Zero<N>()};
    path.u_compression_end = in.u0;
    return path;
  }
  const N ratio = in.wtn / in.wnn;
  const bool backwards = IsPositive(in.wtn);
  in.u0 = in.v0 * ratio;
  path.first = SlipSlopes(in, backwards);
  path.first.u = path.first.v * ratio;
  path.sticks = !IsNegative(AddProduct(-in.wnn, in.mu_static, Abs(in.wtn)));
  path.second = SlipSlopes(in, !backwards);
  path.second.u = path.second.v * ratio;
  return path;
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

template <typename N>
HWY_INLINE void Compress(const Inputs<N>& in, const Path<N>& path, Solution<N>& x) {
  State<N> at = {Zero<N>(), Zero<N>(), in.u0, in.v0};
  x.stops_in_compression = path.stops && IsNegative(path.v_stop);
  x.stop = at;
  if (!x.stops_in_compression) {
    Begin(path.first, -in.v0 / path.first.v, path.u_compression_end, Zero<N>(), at, x.compression);
  } else {
    x.stuck_compression = -path.v_stop / path.second.v;
    const N u = path.second.u * x.stuck_compression;
    if (path.slips_first) {
      Begin(path.first, -in.u0 / path.first.u, Zero<N>(), path.v_stop, at, x.compression);
      x.stop = at;
      Advance(path.second, x.stuck_compression, u, Zero<N>(), at, x.compression);
    } else {
      Begin(path.second, x.stuck_compression, u, Zero<N>(), at, x.compression);
    }
  }
  x.compression_end = at;
}

// `stop_ahead` is true if slip has not stopped yet but will at path.v_stop.
template <typename N>
HWY_INLINE Rebound<N> FindNewton(const Inputs<N>& in, const Path<N>& path, const N& slope, bool stop_ahead) {
  const N v1 = -in.coefficient * in.v0;
  const N beyond = v1 - path.v_stop;
  if (!stop_ahead || IsNegative(beyond)) return {false, v1 / slope, Zero<N>(), v1};
  return {true, path.v_stop / slope, beyond / path.second.v, v1};
}

template <typename N>
HWY_INLINE Rebound<N> FindPoisson(const Inputs<N>& in, const Path<N>& path, const N& tau_c, const N& slope,
                                  bool stop_ahead) {
  const N step = in.coefficient * tau_c;
  if (!stop_ahead) return {false, step, Zero<N>(), slope * step};
  const N before = path.v_stop / slope;
  const N after = step - before;
  if (IsNegative(after)) return {false, step, Zero<N>(), slope * step};
  return {true, before, after, path.v_stop + path.second.v * after};
}

// On a piece v^2 grows by twice its slope times the work, and the impulse is the change of v^2 over the sum of the v.
template <typename N>
HWY_INLINE Rebound<N> FindEnergetic(const Inputs<N>& in, const Path<N>& path, const N& stored_twice, const N& slope,
                                    bool stop_ahead) {
  const N work = in.coefficient * in.coefficient * stored_twice;
  if (stop_ahead) {
    const N before = path.v_stop / slope;
    const N beyond = work - path.v_stop * before;
    if (!IsNegative(beyond)) {
      const N v1 = Sqrt(path.v_stop * path.v_stop + path.second.v * beyond);
      return {true, before, beyond / (v1 + path.v_stop), v1};
    }
  }
  const N v1 = Sqrt(slope * work);
  return {false, v1 / slope, Zero<N>(), v1};
}

template <typename N>
HWY_INLINE Rebound<N> FindRebound(RestitutionLaw law, const Inputs<N>& in, const Path<N>& path, const Solution<N>& x,
                                  const N& slope, bool stop_ahead) {
  if (!IsPositive(in.coefficient)) {
    return {stop_ahead && !IsPositive(path.v_stop), Zero<N>(), Zero<N>(), Zero<N>()};
  }
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
HWY_INLINE void Restore(RestitutionLaw law, const Inputs<N>& in, const Path<N>& path, Solution<N>& x) {
  State<N> at = x.compression_end;
  Slopes<N> slopes = path.first;
  if (x.stops_in_compression) slopes = path.second;
  const bool stop_ahead = path.stops && !x.stops_in_compression;
  x.rebound = FindRebound(law, in, path, x, slopes.v, stop_ahead);
  const Rebound<N>& rebound = x.rebound;
  x.stops_in_restitution = rebound.passes_stop;
  if (rebound.passes_stop) {
    Begin(slopes, rebound.before, Zero<N>(), path.v_stop, at, x.restitution);
    x.stop = at;
    Advance(path.second, rebound.after, path.second.u * rebound.after, rebound.v1, at, x.restitution);
  } else {
    N u1 = at.u + slopes.u * rebound.before;
    // Slip that has not stopped has not reversed; a u1 of the other sign is rounding.
    if (stop_ahead && IsNegative(Signed(u1, IsNegative(at.u)))) u1 = Zero<N>();
    Begin(slopes, rebound.before, u1, rebound.v1, at, x.restitution);
  }
  x.end = at;
}

// The problem must not be separating.
template <typename N>
HWY_INLINE Course<N> Follow(const Problem& problem) {
  Course<N> course;
  course.in = MakeInputs<N>(problem);
  const Inputs<N>& in = course.in;
  Path<N>& path = course.path;
  Solution<N>& x = course.x;
  path = in.rank_one ? RankOnePath(course.in) : FullRankPath(in);
  course.locked = in.rank_one && path.stops && path.sticks;
  Compress(in, path, x);
  x.stops_in_restitution = false;
  x.restitution = {Zero<N>(), Zero<N>()};
  x.end = x.compression_end;
  if (course.locked) {
    x.stop = x.compression_end;
  } else {
    Restore(problem.law, in, path, x);
  }
  return course;
}

}  // namespace ricochet::planar::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
