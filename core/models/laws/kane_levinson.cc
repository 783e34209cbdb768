#include "core/models/laws/kane_levinson.h"

#include <algorithm>
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
    return result;
  }
  // The contact comes to rest along t whatever the impulse is, so that every impulse of the cone solves the law.
  AppendAtRatio(impact, -input.mu, result);
  if (input.mu == 0.0) return result;
  AppendAtRatio(impact, input.mu, result);
  result.ends = std::move(result.solutions);
  const auto work = [&](const ImpactSolution& end) { return end.f * input.u0; };
  result.solutions = {*std::min_element(result.ends.begin(), result.ends.end(),
                                        [&](const auto& x, const auto& y) { return work(x) < work(y); })};
  if (input.u0 == 0.0) result.solutions = {*impact.AtRatio(0.0)};  // No friction does any work.
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
