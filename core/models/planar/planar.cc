// This file is compiled once for each SIMD target (foreach_target.h includes it again), so that fma is an instruction
// on targets that have one. The target is chosen at run time.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/models/planar/planar.cc"
#include "core/models/planar/planar.h"

#include <cmath>
#include <cstddef>
#include <limits>

// Highway prescribes the order of these includes.
// clang-format off
#include "hwy/foreach_target.h"
#include "core/models/planar/kernel-inl.h"
#include "core/models/planar/report-inl.h"
#include "core/models/planar/rounding-inl.h"
// clang-format on

HWY_BEFORE_NAMESPACE();
namespace ricochet::planar::HWY_NAMESPACE {

// Nothing is known of an impact that has no end.
inline constexpr double kInfinity = std::numeric_limits<double>::infinity();
inline constexpr RoundingErrors kNoErrors = {
    .velocity = kInfinity, .impulse = kInfinity, .work = kInfinity, .counted_impulse = kInfinity};

template <typename N>
HWY_INLINE Impact SolveOne(const Problem& problem) {
  const Course<N> course = Follow<N>(problem.law, MakeInputs<N>(problem));
  return Report(problem, course, MakeNumbers(kAllParts, course));
}

template <typename N>
HWY_INLINE Impact SolveOne(const Problem& problem, RoundingErrors& errors, ImpactErrors* numbers) {
  const Course<N> course = Follow<N>(problem.law, MakeInputs<N>(problem));
  const EndErrors<CoarseOf<N>> end_errors = ErrorsOf(course);
  errors = course.jammed ? kNoErrors : ToErrors(CompensatedBounds(course, end_errors));
  const Impact impact = Report(problem, course, MakeNumbers(kAllParts, course));
  if (numbers != nullptr)
    *numbers = course.jammed ? ImpactErrors() : NumberErrorsOf(problem, course, end_errors, impact);
  return impact;
}

using Moderate = ricochet::HWY_NAMESPACE::DoubleDouble<double>;

Impact SolveModerate(const Problem& problem) { return SolveOne<Moderate>(problem); }

Impact SolveModerateWithErrors(const Problem& problem, RoundingErrors& errors, ImpactErrors* numbers) {
  return SolveOne<Moderate>(problem, errors, numbers);
}

// The seven numbers from wtt to mu_static lie one after another.
static_assert(offsetof(Problem, w) == 0 && offsetof(PlanarDelassus, nn) == 2 * sizeof(double) &&
              offsetof(Problem, mu_static) == 6 * sizeof(double));

// Says what IsModerate of core/models/planar/rounding-inl.h says, for four numbers at once instead of one.
HWY_INLINE bool IsModerateAlone(const Problem& problem) {
  namespace hn = hwy::HWY_NAMESPACE;
  constexpr double kOfMatrix[] = {kLeastModerate, kLeastCoupling, kLeastModerate, kLeastCoupling};  // W and u0
  constexpr double kOfOthers[] = {kLeastCoupling, kLeastModerate, kLeastModerate, kLeastModerate};  // u0 to mu_static
  const hn::CappedTag<double, 4> d;
  const auto are_within = [&d](const double* least, const double* numbers) HWY_ATTR {
    const auto size = hn::Abs(hn::LoadU(d, numbers));
    const auto is_moderate = hn::And(hn::Ge(size, hn::LoadU(d, least)), hn::Le(size, hn::Set(d, kMostModerate)));
    return hn::AllTrue(d, hn::Or(is_moderate, hn::Eq(size, hn::Zero(d))));
  };
  const double* const numbers = &problem.w.tt;
  const double coefficient = problem.coefficient;
  bool all = coefficient <= kMostModerate && (coefficient >= kLeastModerate || coefficient == 0.0);
  for (size_t i = 0; i < 4; i += hn::Lanes(d)) {
    all = Both(all, Both(are_within(kOfMatrix + i, numbers + i), are_within(kOfOthers + i, numbers + 3 + i)));
  }
  return all;
}

PlainImpact SolvePlainApproaching(const Problem& problem, ImpactErrors* number_errors) {
  using N = Plain<double>;
  const Course<N> course = Follow<N>(problem.law, MakeInputs<N>(problem));
  const EndErrors<N> errors = ErrorsOf(course);
  Numbers<N> numbers = MakeNumbers(kAllParts, course);
  const bool keeps_limits = KeepsLimits(course);
  KeepLimits(keeps_limits, course, numbers);
  PlainImpact plain = {.impact = Report(problem, course, numbers),
                       .errors = ToErrors(PlainBounds(course, errors)),
                       .proved = IsModerateAlone(problem) && !course.jammed && PathIsSure(course, errors) &&
                                 (keeps_limits || LimitsAreSure(course, errors))};
  if (number_errors != nullptr) *number_errors = NumberErrorsOf(problem, course, errors, plain.impact);
  return plain;
}

}  // namespace ricochet::planar::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

#include "core/numerics/wide.h"

namespace ricochet::planar {

HWY_EXPORT(SolveModerate);
HWY_EXPORT(SolveModerateWithErrors);
HWY_EXPORT(SolvePlainApproaching);

namespace {

bool FitsDoubleDouble(const Problem& problem) {
  return HWY_NAMESPACE::IsModerate(HWY_NAMESPACE::MakeInputs<HWY_NAMESPACE::Plain<double>>(problem));
}

Impact SolveSeparating(const Problem& problem) {
  return Separating<Impact>(HWY_NAMESPACE::MakeInputs<Wide>(problem).rank_one ? 1 : 2, problem.u0, problem.v0);
}

}  // namespace

PlainImpact SolvePlain(const Problem& problem, ImpactErrors* numbers) {
  if (problem.v0 < 0.0) return HWY_DYNAMIC_DISPATCH(SolvePlainApproaching)(problem, numbers);
  if (numbers != nullptr) *numbers = NoErrors();
  return {.impact = SolveSeparating(problem), .proved = true};
}

Impact Solve(const Problem& problem, RoundingErrors& errors, ImpactErrors* numbers) {
  if (problem.v0 < 0.0) {
    if (!FitsDoubleDouble(problem)) return HWY_NAMESPACE::SolveOne<Wide>(problem, errors, numbers);
    return HWY_DYNAMIC_DISPATCH(SolveModerateWithErrors)(problem, errors, numbers);
  }
  errors = {};
  if (numbers != nullptr) *numbers = NoErrors();
  return SolveSeparating(problem);
}

Impact Solve(const Problem& problem) {
  if (problem.v0 >= 0.0) return SolveSeparating(problem);
  if (!FitsDoubleDouble(problem)) return HWY_NAMESPACE::SolveOne<Wide>(problem);
  return HWY_DYNAMIC_DISPATCH(SolveModerate)(problem);
}

Instant At(const Problem& problem, const Impact& impact, double tau) {
  if (impact.event_count < 2) return {.tau = tau, .u = problem.u0, .v = problem.v0};
  const Instant* end = impact.events.data() + 1;
  while (end < impact.events.data() + impact.event_count - 1 && tau > end->tau) ++end;
  const Instant& begin = end[-1];
  const double length = end->tau - begin.tau;
  if (!(tau < end->tau)) return {.tau = tau, .f = end->f, .u = end->u, .v = end->v};
  const double passed = (tau - begin.tau) / length;
  const double left = (end->tau - tau) / length;
  const auto between = [&](double from, double to) { return std::fma(from, left, to * passed) + 0.0; };
  return {.tau = tau, .f = between(begin.f, end->f), .u = between(begin.u, end->u), .v = between(begin.v, end->v)};
}

}  // namespace ricochet::planar

#endif  // HWY_ONCE
