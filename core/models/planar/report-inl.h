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
#include "core/numerics/codes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace ricochet::planar::HWY_NAMESPACE {

// A double, or a vector of them.
template <typename N>
using RoundedOf = decltype(Rounded(N()));

// The numbers that cost a division or a root each, and are computed if they are asked for.
inline constexpr unsigned kPartNewton = 1;
inline constexpr unsigned kPartPoisson = 2;
inline constexpr unsigned kPartEnergetic = 4;
inline constexpr unsigned kPartTangential = 8;
inline constexpr unsigned kAllParts = 15;

// The coefficients have no meaning if they have not been asked for.
template <typename N>
struct Numbers {
  RoundedOf<N> newton, poisson, energetic, tangential, energetic_excess;
  RoundedOf<N> u1, v1, tau_compression, tau1, f1, f_compression;
  RoundedOf<N> work_normal_compression, work_normal_restitution;
  RoundedOf<N> work_tangential_compression, work_tangential_restitution;
  RoundedOf<N> energy_change;
  MaskOf<N> sharp_limit_broken, energy_limit_broken;
};

template <typename N>
HWY_INLINE RoundedOf<N> Fill(double value) {
  return ricochet::HWY_NAMESPACE::Lanes<RoundedOf<N>>::Fill(value);
}

// Replaces a difference of terms of size `scale` by 0 if it may be rounding alone. Plain arithmetic bounds its rounding
// and needs no threshold.
template <typename N>
HWY_INLINE N WithoutRounding(const N& difference, const N& scale) {
  if constexpr (!N::kCompensated) return difference;
  const MaskOf<N> exceeds = IsPositive(Abs(difference) - N::Constant(0x1p-96) * scale);
  return Select(exceeds, difference, Zero<N>());
}

// Adding 0 turns -0 into 0, because a result of 0 has no sign.
template <typename N>
HWY_INLINE RoundedOf<N> Out(const N& value) {
  return Rounded(value) + Fill<N>(0.0);
}

template <typename N>
HWY_INLINE Instant MakeInstant(EventKind kind, const State<N>& at) {
  return {.kind = kind, .tau = Out(at.tau), .f = Out(at.f), .u = Out(at.u), .v = Out(at.v)};
}

// The numbers of the impact must be set.
template <typename N>
HWY_INLINE void WriteEvents(const Problem& problem, const Course<N>& course, Impact& impact) {
  const Solution<N>& x = course.x;
  Instant* next = impact.events.data();
  *next++ = {.kind = EventKind::kStart, .tau = 0.0, .f = 0.0, .u = problem.u0, .v = problem.v0};
  const bool locked = course.held && !course.jammed;
  const bool stops_at_compression_end = x.stops_in_restitution && !IsPositive(x.stop.v);
  const bool stops_before = (x.stops_in_compression && course.path.slips_first && IsPositive(x.stop.tau)) ||
                            stops_at_compression_end || locked;
  if (stops_before) *next++ = MakeInstant(EventKind::kSlipStops, x.stop);
  if (!(course.jammed && x.stops_in_compression)) {
    *next++ = {.kind = EventKind::kCompressionEnds,
               .tau = impact.tau_compression,
               .f = impact.f_compression,
               .u = Out(x.compression_end.u),
               .v = 0.0};
  }
  const bool stops_after = x.stops_in_restitution && !stops_at_compression_end;
  if (stops_after && !locked) *next++ = MakeInstant(EventKind::kSlipStops, x.stop);
  if (!course.held) {
    *next++ = {.kind = EventKind::kRestitutionEnds, .tau = impact.tau1, .f = impact.f1, .u = impact.u1, .v = impact.v1};
  }
  impact.event_count = static_cast<int>(next - impact.events.data());
}

// The numbers of regimes.
template <typename N>
using RegimeCodes = ricochet::HWY_NAMESPACE::Codes<RoundedOf<N>>;
template <typename N>
using RegimeCode = typename RegimeCodes<N>::Type;

template <typename N>
HWY_INLINE RegimeCode<N> CodeOfRegime(Regime regime) {
  return RegimeCodes<N>::Fill(static_cast<uint64_t>(regime));
}

template <typename N>
HWY_INLINE RegimeCode<N> EitherRegime(const MaskOf<N>& condition, Regime yes, Regime no) {
  return RegimeCodes<N>::Select(condition, CodeOfRegime<N>(yes), CodeOfRegime<N>(no));
}

template <typename N>
HWY_INLINE RegimeCode<N> RegimeOf(const Course<N>& course) {
  using Codes = RegimeCodes<N>;
  const Inputs<N>& in = course.in;
  const Path<N>& path = course.path;
  const MaskOf<N>& early = course.x.stops_in_compression;
  const MaskOf<N> stopped = Either(early, course.x.stops_in_restitution);
  const MaskOf<N> smooth = Not(Both(IsPositive(in.mu_static), IsPositive(in.wtt)));
  const MaskOf<N> without_friction = Not(Either(IsPositive(in.mu), Both(stopped, path.sticks)));
  const MaskOf<N> slides = Not(Both(stopped, Either(path.slips_first, path.sticks)));
  const auto in_compression = EitherRegime<N>(path.sticks, Regime::kStickInCompression, Regime::kReversalInCompression);
  const auto in_restitution = EitherRegime<N>(path.sticks, Regime::kStickInRestitution, Regime::kReversalInRestitution);
  RegimeCode<N> regime = Codes::Select(early, in_compression, in_restitution);
  regime = Codes::Select(slides, CodeOfRegime<N>(Regime::kSliding), regime);
  regime = Codes::Select(Either(smooth, without_friction), CodeOfRegime<N>(Regime::kFrictionless), regime);
  if (InNoLane(in.rank_one)) return regime;
  // If Wtt = 0, friction moves nothing, but it still has an impulse where the contact slips.
  const MaskOf<N> rubs = Both(Not(IsPositive(in.wtt)), Either(IsPositive(path.first.f), IsNegative(path.first.f)));
  regime = Codes::Select(Both(in.rank_one, rubs), CodeOfRegime<N>(Regime::kSliding), regime);
  return Codes::Select(course.held, EitherRegime<N>(course.jammed, Regime::kWedged, Regime::kLocked), regime);
}

// eta, eta - 1, and whether the latter is positive.
template <typename N>
HWY_INLINE void FindEnergeticCoefficient(unsigned parts, const Course<N>& course, Numbers<N>& numbers) {
  const N one = N::Constant(1.0);
  if (course.law == RestitutionLaw::kEnergetic) {
    numbers.energetic = Rounded(course.in.coefficient);
    numbers.energetic_excess = numbers.energetic - Fill<N>(1.0);
    numbers.sharp_limit_broken = Fill<N>(1.0) < numbers.energetic;
    return;
  }
  const N square = course.x.restitution.normal / -course.x.compression.normal;
  const N difference = WithoutRounding(square - one, one + square);
  numbers.sharp_limit_broken = IsPositive(difference);
  if ((parts & kPartEnergetic) == 0) return;
  const N energetic = Sqrt(square);
  numbers.energetic = Out(energetic);
  numbers.energetic_excess = Out(difference / (one + energetic));
}

// The stated coefficient is taken as it is, and the other two follow from the path. All three are 0 if there is no
// restitution.
template <typename N>
HWY_INLINE void FindCoefficients(unsigned parts, const Course<N>& course, Numbers<N>& numbers) {
  const Solution<N>& x = course.x;
  const RoundedOf<N> stated = Rounded(course.in.coefficient);
  numbers.newton = numbers.poisson = stated;
  if ((parts & kPartNewton) && course.law != RestitutionLaw::kNewton) numbers.newton = Out(x.end.v / -course.in.v0);
  if ((parts & kPartPoisson) && course.law != RestitutionLaw::kPoisson) {
    numbers.poisson = Out((x.end.tau - x.compression_end.tau) / x.compression_end.tau);
  }
  numbers.energetic = numbers.energetic_excess = stated;
  FindEnergeticCoefficient(parts, course, numbers);
  const MaskOf<N> restores = Both(Not(course.held), IsPositive(course.in.coefficient));
  if (InAllLanes(restores)) return;
  const RoundedOf<N> zero = Fill<N>(0.0);
  numbers.newton = Select(restores, numbers.newton, zero);
  numbers.poisson = Select(restores, numbers.poisson, zero);
  numbers.energetic = Select(restores, numbers.energetic, zero);
  numbers.energetic_excess = Select(restores, numbers.energetic_excess, Fill<N>(-1.0));
  numbers.sharp_limit_broken = Both(restores, numbers.sharp_limit_broken);
}

// Twice the change of energy.
template <typename N>
HWY_INLINE N TwiceEnergyChange(const Inputs<N>& in, const State<N>& end) {
  const N tangential = end.f * (in.u0 + end.u);
  const N normal = end.tau * (in.v0 + end.v);
  if constexpr (!N::kCompensated) return tangential + normal;
  const N scale = Abs(end.f) * Abs(in.u0) + end.tau * -in.v0 + Abs(tangential) + Abs(normal);
  return WithoutRounding(tangential + normal, scale);
}

template <typename N>
HWY_INLINE Numbers<N> MakeNumbers(unsigned parts, const Course<N>& course) {
  const Solution<N>& x = course.x;
  const N half = N::Constant(0.5);
  const N twice_change = TwiceEnergyChange(course.in, x.end);
  Numbers<N> numbers;
  FindCoefficients(parts, course, numbers);
  numbers.energy_limit_broken = IsPositive(twice_change);
  numbers.tangential = Fill<N>(0.0);
  if (parts & kPartTangential) numbers.tangential = Out(x.end.f / x.end.tau);
  numbers.u1 = Out(x.end.u);
  numbers.v1 = Out(x.end.v);
  numbers.tau_compression = Out(x.compression_end.tau);
  numbers.tau1 = Out(x.end.tau);
  numbers.f1 = Out(x.end.f);
  numbers.f_compression = Out(x.compression_end.f);
  numbers.work_normal_compression = Out(half * x.compression.normal);
  numbers.work_normal_restitution = Out(half * x.restitution.normal);
  numbers.work_tangential_compression = Out(half * x.compression.tangential);
  numbers.work_tangential_restitution = Out(half * x.restitution.tangential);
  numbers.energy_change = Out(half * twice_change);
  return numbers;
}

// Where theory says that limits are kept, a gain is rounding.
template <typename N>
HWY_INLINE void KeepLimits(const MaskOf<N>& keeps, const Course<N>& course, Numbers<N>& numbers) {
  if (InNoLane(keeps)) return;
  const RoundedOf<N> zero = Fill<N>(0.0);
  const RoundedOf<N> stated = Rounded(course.in.coefficient);
  numbers.energy_change = Select(Both(keeps, zero < numbers.energy_change), zero, numbers.energy_change);
  const MaskOf<N> exceeds = Both(keeps, zero < numbers.energetic_excess);
  numbers.energetic = Select(exceeds, stated, numbers.energetic);
  numbers.energetic_excess = Select(exceeds, stated - Fill<N>(1.0), numbers.energetic_excess);
  numbers.sharp_limit_broken = Both(Not(keeps), numbers.sharp_limit_broken);
  numbers.energy_limit_broken = Both(Not(keeps), numbers.energy_limit_broken);
}

template <typename N>
HWY_INLINE Impact Report(const Problem& problem, const Course<N>& course, const Numbers<N>& numbers) {
  Impact impact;
  impact.regime = static_cast<Regime>(RegimeOf(course));
  if (course.jammed) impact.termination = Termination::kRefused;
  impact.w_rank = course.in.rank_one ? 1 : 2;
  impact.sharp_limit_broken = numbers.sharp_limit_broken;
  impact.energy_limit_broken = numbers.energy_limit_broken;
  impact.newton = numbers.newton;
  impact.poisson = numbers.poisson;
  impact.energetic = numbers.energetic;
  impact.tangential = course.jammed && !IsPositive(course.x.end.tau) ? 0.0 : numbers.tangential;
  impact.energetic_excess = numbers.energetic_excess;
  impact.u1 = numbers.u1;
  impact.v1 = numbers.v1;
  impact.tau_compression = numbers.tau_compression;
  impact.tau1 = numbers.tau1;
  impact.f1 = numbers.f1;
  impact.work_normal_compression = numbers.work_normal_compression;
  impact.work_normal_restitution = numbers.work_normal_restitution;
  impact.work_tangential_compression = numbers.work_tangential_compression;
  impact.work_tangential_restitution = numbers.work_tangential_restitution;
  impact.energy_change = numbers.energy_change;
  impact.f_compression = numbers.f_compression;
  WriteEvents(problem, course, impact);
  return impact;
}

}  // namespace ricochet::planar::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
