#include "core/models/laws/kane_levinson.h"

#include <cmath>
#include <utility>

#include "core/models/laws/impact_law_parts.h"

namespace ricochet::laws {
namespace {

void AppendAtRatio(const NewtonImpact& impact, double ratio, ImpactLawResult& result) {
  if (const auto solution = impact.AtRatio(ratio)) result.solutions.push_back(*solution);
}

ImpactLawResult SolveRankOne(const PlanarProblem& input, const NewtonImpact& impact) {
  ImpactLawResult result;
  const double final_slip = impact.tangential_numerator();
  if (final_slip != 0.0) {
    AppendAtRatio(impact, -input.mu * Sign(final_slip), result);
  } else if (input.w.tn == 0.0 || input.mu == 0.0) {
    AppendAtRatio(impact, 0.0, result);
  } else {
    AppendAtRatio(impact, -input.mu, result);
    AppendAtRatio(impact, input.mu, result);
  }
  return result;
}

}  // namespace

ImpactLawResult SolveKaneLevinson(const PlanarProblem& input, double e) {
  const NewtonImpact impact(input, e);
  if (auto trivial = impact.Trivial()) return *std::move(trivial);
  if (impact.rank_one()) return SolveRankOne(input, impact);

  ImpactLawResult result;
  const double g = impact.tangential_numerator();
  const double cone = input.mu * impact.normal_numerator();
  if (std::abs(g) <= cone) {
    result.solutions.push_back(impact.Solution(-g / impact.det(), impact.normal_numerator() / impact.det(), 0.0));
  }
  for (const double s : {1.0, -1.0}) {
    if (s * g > cone) AppendAtRatio(impact, -input.mu * s, result);
  }
  return result;
}

}  // namespace ricochet::laws
