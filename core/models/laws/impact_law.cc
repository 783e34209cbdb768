#include "core/models/laws/impact_law.h"

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

}  // namespace ricochet::laws
