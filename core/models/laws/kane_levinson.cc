// Kane and Levinson's law: Coulomb's law between the whole impulse and the slip after the impact.
//
// T. R. Kane and D. A. Levinson, Dynamics: Theory and Applications, McGraw-Hill (1985); here static and kinetic
// friction are equal. v1 = -e v0, and either
//
//   stick   u1 = 0,  |f| <= mu tau1            or
//   slip    u1 != 0, f = -mu sgn(u1) tau1
//
// The law ignores the slip on the way, so that it can create energy: in Kane's paradox a double pendulum rebounds with
// several times the energy it had. A positive definite W has exactly one solution. At rank one there may be none,
// because friction locks a contact that e > 0 asks to rebound, or a range of impulses, where u1 = 0 whatever they are.
// docs/theory/laws.md has the proof.

#include <algorithm>
#include <utility>

#include "core/models/laws/impact_law.h"
#include "core/models/laws/impact_law_parts.h"
#include "core/numerics/wide.h"

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

// True if the impulse that ends without slip lies beyond the cone, s G > mu T. Near the cone both sides cancel, and
// slip that is small beside u0 may still be far above a rounding error.
bool SlipsAtEnd(const PlanarProblem& input, double e, double s) {
  const auto exactly = [](double x) { return Wide::Exactly(x); };
  const Wide along = exactly(s);
  const Wide mu = exactly(input.mu);
  const Wide u_part = along * exactly(input.w.nn) - mu * exactly(input.w.tn);
  const Wide c_part = along * exactly(input.w.tn) - mu * exactly(input.w.tt);
  const Wide c = -(exactly(input.v0) + exactly(e) * exactly(input.v0));
  return IsPositive(exactly(input.u0) * u_part + c * c_part);
}

}  // namespace

ImpactLawResult SolveKaneLevinson(const PlanarProblem& input, double e) {
  const NewtonImpact impact(input, e);
  if (auto trivial = impact.Trivial()) return *std::move(trivial);
  if (impact.rank_one()) return SolveRankOne(input, impact);

  ImpactLawResult result;
  bool sticks = true;
  for (const double s : {1.0, -1.0}) {
    if (!SlipsAtEnd(input, e, s)) continue;
    sticks = false;
    AppendAtRatio(impact, -input.mu * s, result);
  }
  if (sticks) {
    result.solutions.push_back(
        impact.Solution(-impact.tangential_numerator() / impact.det(), impact.normal_numerator() / impact.det(), 0.0));
  }
  return result;
}

}  // namespace ricochet::laws
