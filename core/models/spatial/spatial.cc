// This file is compiled once for each SIMD target, as foreach_target.h includes it again, so that fma is an instruction
// where there is one. The target is chosen at run time.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/models/spatial/spatial.cc"
#include "core/models/spatial/spatial.h"

#include "core/models/spatial/attempts.h"

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
  if (problem.v0 >= 0.0) return SeparatingImpact(problem);
  const int rank = problem.Delassus().Rank();
  Impact best;
  Attempts attempts(problem.tolerance, best);
  while (attempts.NeedsAnotherAfter(HWY_DYNAMIC_DISPATCH(SolveTo)(problem, rank, attempts.tolerance()))) {
  }
  return best;
}

}  // namespace ricochet::spatial

#endif  // HWY_ONCE
