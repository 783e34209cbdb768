// Compiled once for each SIMD target (foreach_target.h includes this file again), so that fma is an instruction where
// there is one; then dispatched at run time.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/models/spatial/spatial.cc"
#include "core/models/spatial/spatial.h"

#include <cmath>
#include <limits>

#include "core/contact/delassus.h"

// The order is Highway's.
// clang-format off
#include "hwy/foreach_target.h"
#include "core/models/spatial/solver-inl.h"
// clang-format on

HWY_BEFORE_NAMESPACE();
namespace ricochet::spatial::HWY_NAMESPACE {

Impact SolveTo(const Problem& problem, double tolerance) { return Solver<double>(problem, tolerance).Run(); }

}  // namespace ricochet::spatial::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace ricochet::spatial {

HWY_EXPORT(SolveTo);

namespace {

// Nothing changes.
Impact SolveSeparating(const Problem& problem) {
  Impact impact = Separating<Impact>(
      SpatialDelassus{{problem.w11, problem.w12, problem.w13, problem.w22, problem.w23, problem.w33}}.Rank(),
      problem.u0, problem.v0);
  impact.closed_form = true;
  return impact;
}

}  // namespace

Impact Solve(const Problem& problem) {
  if (problem.v0 >= 0.0) return SolveSeparating(problem);
  // An event that depends on the path sensitively can make more of the steps' errors than was allowed for: once more,
  // to a smaller tolerance.
  constexpr int kTries = 3;
  constexpr double kSmallestTolerance = 1e-17;
  constexpr double kMargin = 0.3;
  double tolerance = problem.tolerance;
  Impact best;
  best.error_estimate = std::numeric_limits<double>::infinity();
  for (int i = 0; i < kTries; ++i) {
    const Impact impact = HWY_DYNAMIC_DISPATCH(SolveTo)(problem, tolerance);
    const double estimate = impact.error_estimate;
    if (i == 0 || estimate < best.error_estimate) best = impact;
    if (estimate <= problem.tolerance || tolerance <= kSmallestTolerance) break;
    tolerance = std::fmax(kMargin * tolerance * (problem.tolerance / estimate), kSmallestTolerance);
  }
  if (!best.converged) best.regime = Regime::kWedged;
  return best;
}

}  // namespace ricochet::spatial

#endif  // HWY_ONCE
