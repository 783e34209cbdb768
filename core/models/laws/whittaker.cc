// Whittaker's law: friction acts at its limit, in one direction, for the whole impact.
//
// E. T. Whittaker, Analytical Dynamics of Particles and Rigid Bodies, Cambridge (1904), chapter VIII; Lubarda (2009),
// Eq. (50). The tangential impulse opposes the slip before the impact:
//
//   f = -mu sgn(u0) tau1,   v1 = -e v0   =>   tau1 = -(1 + e) v0/(wnn - mu sgn(u0) wtn)
//
// The law ignores slip that stops or reverses on the way: friction then does positive work, and the law can create
// energy. sgn(0) = 0, so that f = 0 if there is no slip before the impact.

#include <utility>

#include "core/models/laws/impact_law.h"
#include "core/models/laws/impact_law_parts.h"

namespace ricochet::laws {

ImpactLawResult SolveWhittaker(const PlanarProblem& input, double e) {
  const NewtonImpact impact(input, e);
  if (auto trivial = impact.Trivial()) return *std::move(trivial);
  return AtMostOne(impact.AtRatio(-input.mu * Sign(input.u0)));
}

}  // namespace ricochet::laws
