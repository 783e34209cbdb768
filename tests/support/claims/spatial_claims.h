// SpatialClaims: what the spatial model claims and achieves on random scenes.
//
// The reference is the same algorithm with 64-bit mantissas at a tolerance of 1e-16. It is valid because its errors are
// 1e4 times smaller than those of every tolerance here, and because it agrees with what shares nothing with it: a
// Runge-Kutta method for Keller's equations as they stand (SpatialTest) and 48 impacts of 40 digits (spatial.csv).

#ifndef RICOCHET_TESTS_SUPPORT_CLAIMS_SPATIAL_CLAIMS_H_
#define RICOCHET_TESTS_SUPPORT_CLAIMS_SPATIAL_CLAIMS_H_

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "core/models/spatial/solver-inl.h"
#include "core/models/spatial/spatial.h"
#include "tests/support/claims/claims.h"
#include "tests/support/scenes/spatial_scenes.h"

namespace ricochet::spatial {

inline constexpr double kClaimTolerances[] = {1e-2, 1e-3, 1e-4, 1e-6, 1e-8, 1e-10, 1e-12};

// The largest error of a velocity after the impact over max(|u0|, |v0|).
inline double VelocityError(const Problem& problem, const Impact& found, const Impact& reference) {
  const double scale = std::max(std::hypot(problem.u0[0], problem.u0[1]), std::fabs(problem.v0));
  return std::max(std::hypot(found.u1[0] - reference.u1[0], found.u1[1] - reference.u1[1]),
                  std::fabs(found.v1 - reference.v1)) /
         scale;
}

// Scenes near every threshold, of all sizes between 1e-100 and 1e100.
inline Problem HardScene(SceneSource& source) {
  Problem problem = source.NearSingular();
  if (source.Below(2) == 0) return problem;
  const double speed = std::pow(10.0, source.Uniform(-100.0, 100.0));
  const double mobility = std::pow(10.0, source.Uniform(-100.0, 100.0));
  for (double* velocity : {&problem.u0[0], &problem.u0[1], &problem.v0}) *velocity *= speed;
  for (double* entry : {&problem.w11, &problem.w12, &problem.w13, &problem.w22, &problem.w23, &problem.w33}) {
    *entry *= mobility;
  }
  return problem;
}

// Solves a scene and adds what it claims and achieves.
inline void AddClaim(const Problem& problem, ClaimTally& tally) {
  const Impact reference = HWY_NAMESPACE::Solver<long double>(problem, problem.Delassus().Rank(), 1e-16L).Run();
  const Impact found = Solve(problem);
  tally.Add(found.error_estimate, VelocityError(problem, found, reference));
}

inline ClaimTally SpatialClaims(bool hard, double tolerance, int count, uint64_t seed) {
  SceneSource source(seed);
  ClaimTally tally(tolerance);
  for (int i = 0; i < count; ++i) {
    Problem problem = hard ? HardScene(source) : source.Typical();
    problem.tolerance = tolerance;
    AddClaim(problem, tally);
  }
  return tally;
}

}  // namespace ricochet::spatial

#endif  // RICOCHET_TESTS_SUPPORT_CLAIMS_SPATIAL_CLAIMS_H_
