#include "core/plan/needs_spatial.h"

#include <algorithm>
#include <cmath>

#include "core/plan/perturbed_path.h"

namespace ricochet {

bool NeedsSpatial(const spatial::Problem& problem, double tolerance) {
  // Covers the rounding of both sides of a comparison.
  constexpr double kMargin = 0x1p-19;
  const auto& [u1, u2] = problem.u0;
  const bool is_isotropic =
      problem.w12 == 0.0 && problem.w11 == problem.w22 && problem.w13 == 0.0 && problem.w23 == 0.0;
  // Beyond this coupling the rounding of a slope could exceed the margin.
  const bool is_steep = !(problem.mu * (std::fabs(problem.w13) + std::fabs(problem.w23)) < 0x1p20 * problem.w33);
  if (!(problem.v0 < 0.0) || is_isotropic || is_steep) return false;
  // In the scales and letters of docs/theory/plan.md, section 4.
  const double speed = -problem.v0;
  const double most = tolerance * (1.0 + kMargin);
  const double drive = problem.mu * ((problem.w11 + problem.w22) / problem.w33);  // the least size of friction
  if (!(drive > most)) return false;
  const double size = std::sqrt(u1 * u1 + u2 * u2);
  if (size == 0.0) return true;  // Slip that is 0 at the start has no direction to keep.
  const double e1 = u1 / size;
  const double e2 = u2 / size;
  const double slope = 1.0 - problem.mu * (problem.w13 * e1 + problem.w23 * e2) / problem.w33;
  if (slope < 0.5 * kLeastSlope) return true;
  if (slope < 0x1p-10) return false;
  const double g = (e1 * problem.w23 - e2 * problem.w13) - problem.mu * (e1 * (problem.w12 * e1 + problem.w22 * e2) -
                                                                         e2 * (problem.w11 * e1 + problem.w12 * e2));
  const double angle = 0.5 * (1.0 + problem.coefficient) * std::fabs(g / problem.w33) / slope * (speed / size);
  return drive * std::min(angle, 2.0) > most * slope;
}

}  // namespace ricochet
