// This file is compiled once for each SIMD target, as foreach_target.h includes it again, so that fma is an instruction
// where there is one. The target is chosen at run time.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/models/spatial/spatial.cc"
#include "core/models/spatial/spatial.h"

#include <cmath>
#include <cstdint>
#include <limits>

// Highway requires this order of includes.
// clang-format off
#include "hwy/foreach_target.h"
#include "core/models/spatial/solver-inl.h"
// clang-format on

HWY_BEFORE_NAMESPACE();
namespace ricochet::spatial::HWY_NAMESPACE {

Impact SolveTo(const Problem& problem, int rank, double tolerance) {
  return Solver<double>(problem, rank, tolerance).Run();
}

}  // namespace ricochet::spatial::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace ricochet::spatial {

HWY_EXPORT(SolveTo);

Impact Solve(const Problem& problem) {
  const int rank = problem.Delassus().Rank();
  if (problem.v0 >= 0.0) {
    auto impact = Separating<Impact>(rank, problem.u0, problem.v0);
    impact.closed_form = true;
    return impact;
  }
  // An event that depends sensitively on the path can amplify the errors of the steps beyond what was allowed for. The
  // impact is then solved again to a smaller tolerance.
  constexpr int kTries = 3;
  constexpr double kSmallestTolerance = 1e-17;
  constexpr double kMargin = 0.3;
  double tolerance = problem.tolerance;
  Impact best;
  best.error_estimate = std::numeric_limits<double>::infinity();
  int64_t steps = 0;
  int64_t right_hand_sides = 0;
  for (int i = 0; i < kTries; ++i) {
    const Impact impact = HWY_DYNAMIC_DISPATCH(SolveTo)(problem, rank, tolerance);
    const double estimate = impact.error_estimate;
    steps += impact.steps;
    right_hand_sides += impact.right_hand_sides;
    if (i == 0 || estimate < best.error_estimate) best = impact;
    if (estimate <= problem.tolerance || tolerance <= kSmallestTolerance) break;
    tolerance = std::fmax(kMargin * tolerance * (problem.tolerance / estimate), kSmallestTolerance);
  }
  best.steps = steps;
  best.right_hand_sides = right_hand_sides;
  if (!best.Converged()) best.regime = Regime::kWedged;
  return best;
}

}  // namespace ricochet::spatial

#endif  // HWY_ONCE
