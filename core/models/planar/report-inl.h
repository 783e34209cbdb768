// The report of a planar path: rounds its numbers, names its regime, and orders its events, in any arithmetic.

// Per-target include guard.
#if defined(RICOCHET_CORE_MODELS_PLANAR_REPORT_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef RICOCHET_CORE_MODELS_PLANAR_REPORT_INL_H_
#undef RICOCHET_CORE_MODELS_PLANAR_REPORT_INL_H_
#else
#define RICOCHET_CORE_MODELS_PLANAR_REPORT_INL_H_
#endif

#include "core/models/planar/kernel-inl.h"
#include "core/models/planar/planar.h"
#include "core/models/restitution_law.h"

HWY_BEFORE_NAMESPACE();
namespace ricochet::planar::HWY_NAMESPACE {

struct Coefficients {
  double newton = 0.0, poisson = 0.0, energetic = 0.0, energetic_excess = -1.0;
};

// Replaces a difference of terms of size `scale` by 0 if it may be rounding alone. Plain arithmetic bounds its rounding and
// needs no threshold.
template <typename N>
HWY_INLINE N WithoutRounding(const N& difference, const N& scale) {
  if (!N::kCompensated) return difference;
  const bool is_rounding = !IsPositive(Abs(difference) - N::Constant(0x1p-96) * scale);
  return Select(is_rounding, Zero<N>(), difference);
}

// Adding 0 turns -0 into 0, because a result of 0 has no sign.
template <typename N>
HWY_INLINE double Out(const N& value) {
  return Rounded(value) + 0.0;
}

template <typename N>
HWY_INLINE Instant MakeInstant(EventKind kind, const State<N>& at) {
  return {.kind = kind, .tau = Out(at.tau), .f = Out(at.f), .u = Out(at.u), .v = Out(at.v)};
}

template <typename N>
HWY_INLINE void WriteEvents(const Problem& problem, const Course<N>& course, Impact& impact) {
  const Solution<N>& x = course.x;
  Instant* next = impact.events.data();
  *next++ = {.kind = EventKind::kStart, .tau = 0.0, .f = 0.0, .u = problem.u0, .v = problem.v0};
  const bool stops_at_compression_end = x.stops_in_restitution && !IsPositive(x.stop.v);
  const bool stops_before =
      (x.stops_in_compression && course.path.slips_first) || stops_at_compression_end || course.locked;
  if (stops_before) *next++ = MakeInstant(EventKind::kSlipStops, x.stop);
  *next++ = MakeInstant(EventKind::kCompressionEnds, x.compression_end);
  if (!course.locked) {
    if (x.stops_in_restitution && !stops_at_compression_end) *next++ = MakeInstant(EventKind::kSlipStops, x.stop);
    *next++ = MakeInstant(EventKind::kRestitutionEnds, x.end);
  }
  impact.event_count = static_cast<int>(next - impact.events.data());
}

template <typename N>
HWY_INLINE Regime RegimeOf(const Inputs<N>& in, const Path<N>& path, const Solution<N>& x) {
  if (in.rank_one && path.stops && path.sticks) return Regime::kLocked;
  const bool stopped = x.stops_in_compression || x.stops_in_restitution;
  const bool smooth = !IsPositive(in.mu_static) || !IsPositive(in.wtt);
  if (smooth || (!IsPositive(in.mu) && !(stopped && path.sticks))) return Regime::kFrictionless;
  if (!stopped || !(path.slips_first || path.sticks)) return Regime::kSliding;
  if (x.stops_in_compression) return path.sticks ? Regime::kStickInCompression : Regime::kReversalInCompression;
  return path.sticks ? Regime::kStickInRestitution : Regime::kReversalInRestitution;
}

// The stated coefficient is taken as it is, and the other two follow from the path. All three are 0 if there is no
// restitution.
template <typename N>
HWY_INLINE Coefficients MakeCoefficients(const Problem& problem, const Course<N>& course) {
  const Solution<N>& x = course.x;
  if (course.locked || problem.coefficient == 0.0) return {};
  Coefficients all;
  all.newton = problem.law == RestitutionLaw::kNewton ? problem.coefficient : Out(x.end.v / -course.in.v0);
  all.poisson = problem.law == RestitutionLaw::kPoisson
                    ? problem.coefficient
                    : Out((x.end.tau - x.compression_end.tau) / x.compression_end.tau);
  if (problem.law == RestitutionLaw::kEnergetic) {
    all.energetic = problem.coefficient;
    all.energetic_excess = problem.coefficient - 1.0;
  } else {
    const N one = N::Constant(1.0);
    const N square = x.restitution.normal / -x.compression.normal;
    const N energetic = Sqrt(square);
    all.energetic = Out(energetic);
    all.energetic_excess = Out(WithoutRounding(square - one, one + square) / (one + energetic));
  }
  return all;
}

// Twice the change of energy.
template <typename N>
HWY_INLINE N TwiceEnergyChange(const Inputs<N>& in, const State<N>& end) {
  const N tangential = end.f * (in.u0 + end.u);
  const N normal = end.tau * (in.v0 + end.v);
  const N scale = Abs(end.f) * Abs(in.u0) + end.tau * -in.v0 + Abs(tangential) + Abs(normal);
  return WithoutRounding(tangential + normal, scale);
}

template <typename N>
HWY_INLINE Impact Report(const Problem& problem, const Course<N>& course) {
  const Solution<N>& x = course.x;
  const Coefficients coefficients = MakeCoefficients(problem, course);
  const N half = N::Constant(0.5);
  const N twice_change = TwiceEnergyChange(course.in, x.end);
  Impact impact;
  impact.regime = RegimeOf(course.in, course.path, x);
  impact.w_rank = course.in.rank_one ? 1 : 2;
  impact.sharp_limit_broken = coefficients.energetic_excess > 0.0;
  impact.energy_limit_broken = IsPositive(twice_change);
  impact.newton = coefficients.newton;
  impact.poisson = coefficients.poisson;
  impact.energetic = coefficients.energetic;
  impact.tangential = Out(x.end.f / x.end.tau);
  impact.energetic_excess = coefficients.energetic_excess;
  impact.u1 = Out(x.end.u);
  impact.v1 = Out(x.end.v);
  impact.tau_compression = Out(x.compression_end.tau);
  impact.tau1 = Out(x.end.tau);
  impact.f1 = Out(x.end.f);
  impact.work_normal_compression = Out(half * x.compression.normal);
  impact.work_normal_restitution = Out(half * x.restitution.normal);
  impact.work_tangential_compression = Out(half * x.compression.tangential);
  impact.work_tangential_restitution = Out(half * x.restitution.tangential);
  impact.energy_change = Out(half * twice_change);
  impact.f_compression = Out(x.compression_end.f);
  WriteEvents(problem, course, impact);
  return impact;
}

}  // namespace ricochet::planar::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
