#include "core/models/laws/brach.h"

#include <utility>

#include "core/models/laws/impact_law_parts.h"

namespace ricochet::laws {

ImpactLawResult SolveBrach(const PlanarProblem& input, double e, double mu_hat) {
  const NewtonImpact impact(input, e);
  if (auto trivial = impact.Trivial()) return *std::move(trivial);
  return AtMostOne(impact.AtRatio(mu_hat));
}

}  // namespace ricochet::laws
