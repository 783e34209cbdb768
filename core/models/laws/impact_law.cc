#include "core/models/laws/impact_law.h"

#include <algorithm>
#include <cmath>
#include <variant>

namespace ricochet::laws {

ImpactLawResult SolveLaw(const ImpactLaw& law, const PlanarProblem& problem) {
  struct Solver {
    const PlanarProblem& of;
    ImpactLawResult operator()(std::monostate) const { return {}; }
    ImpactLawResult operator()(WhittakerLaw law) const { return SolveWhittaker(of, law.e); }
    ImpactLawResult operator()(KaneLevinsonLaw law) const { return SolveKaneLevinson(of, law.e); }
    ImpactLawResult operator()(BrachLaw law) const { return SolveBrach(of, law.e, law.mu_hat); }
    ImpactLawResult operator()(ChatterjeeRuinaLaw law) const { return SolveChatterjeeRuina(of, law.e, law.e_t); }
  };
  return std::visit(Solver{problem}, law);
}

// The largest term of the slip after beside u0. Chatterjee's and Ruina's law alone may leave little of it.
static double CoupledSlip(const ImpactLaw& law, const PlanarProblem& problem) {
  const auto* const by_ratios = std::get_if<ChatterjeeRuinaLaw>(&law);
  if (by_ratios == nullptr) return 0.0;
  return std::abs((by_ratios->e - by_ratios->e_t) * problem.v0 * (problem.w.tn / problem.w.nn));
}

double RelativeErrorOf(const ImpactLaw& law, const PlanarProblem& problem, const ImpactSolution& solution) {
  constexpr double kFewRoundings = 0x1p-48;
  const double before = std::max(std::abs(problem.u0), std::abs(problem.v0));
  const double after = std::max(std::abs(solution.u1), std::abs(solution.v1));
  // The error is relative to the largest of all velocities.
  return kFewRoundings * std::max(1.0, CoupledSlip(law, problem) / before) * std::max(1.0, after / before);
}

}  // namespace ricochet::laws
