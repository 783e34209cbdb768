// This file is compiled once for each SIMD target (foreach_target.h includes it again), so that fma is an instruction on
// targets that have one. The target is chosen at run time.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/models/planar/planar.cc"
#include "core/models/planar/planar.h"

#include <cmath>
// Highway prescribes the order of these includes.
// clang-format off
#include "hwy/foreach_target.h"
#include "core/models/planar/kernel-inl.h"
// clang-format on

HWY_BEFORE_NAMESPACE();
namespace ricochet::planar::HWY_NAMESPACE {

Impact SolveModerate(const Problem& problem) {
  return SolveOne<ricochet::HWY_NAMESPACE::DoubleDouble<double>>(problem);
}

}  // namespace ricochet::planar::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

#include "core/numerics/wide.h"

namespace ricochet::planar {

HWY_EXPORT(SolveModerate);

namespace {

// True if no number on the path can leave the range in which DoubleDouble is exact. Slopes then lie between 2^-186 (two
// products of 2^-80 that cancel to their last bit) and 2^81, v where slip stops is below 2^307, impulses are below 2^493,
// works below 2^800, and v^2 over a slope is above 2^-908.
bool FitsDoubleDouble(const Problem& problem) {
  const auto moderate = [](double value) {
    const double size = std::fabs(value);
    return static_cast<unsigned>(size == 0.0) | static_cast<unsigned>((size >= 0x1p-40) & (size <= 0x1p40));
  };
  return (moderate(problem.w.tt) & moderate(problem.w.tn) & moderate(problem.w.nn) & moderate(problem.u0) &
          moderate(problem.v0) & moderate(problem.mu) & moderate(problem.mu_static) & moderate(problem.coefficient)) !=
         0;
}

}  // namespace

Impact Solve(const Problem& problem) {
  if (problem.v0 >= 0.0) {
    return Separating<Impact>(HWY_NAMESPACE::MakeInputs<Wide>(problem).rank_one ? 1 : 2, problem.u0, problem.v0);
  }
  if (!FitsDoubleDouble(problem)) return HWY_NAMESPACE::SolveOne<Wide>(problem);
  return HWY_DYNAMIC_DISPATCH(SolveModerate)(problem);
}

Instant At(const Problem& problem, const Impact& impact, double tau) {
  if (impact.event_count == 0) return {.tau = tau, .u = problem.u0, .v = problem.v0};
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
