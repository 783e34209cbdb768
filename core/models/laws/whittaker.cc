#include "core/models/laws/whittaker.h"

#include <utility>

#include "core/models/laws/impact_law_parts.h"

namespace ricochet::laws {

ImpactLawResult SolveWhittaker(const PlanarProblem& input, double e) {
  const NewtonImpact impact(input, e);
  if (auto trivial = impact.Trivial()) return *std::move(trivial);
  return AtMostOne(impact.AtRatio(-input.mu * Sign(input.u0)));
}

}  // namespace ricochet::laws
