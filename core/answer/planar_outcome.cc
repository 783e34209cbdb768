#include "core/answer/model_outcomes.h"
#include "core/plan/arithmetic.h"

namespace ricochet::planar {

absl::Status MakeOutcome(const Problem& problem, const PlanarReduction& reduction, double tolerance,
                         const OutcomeDetail& detail, Outcome& outcome) {
  const SolvedImpact<Impact> solved = SolveWithin(problem, tolerance);
  const Impact& impact = solved.impact;
  SetEnd(impact, reduction, 0.0, outcome);
  outcome.accuracy = {.relative_error = solved.relative_error(), .kind = AccuracyKind::kBound};
  outcome.plan.arithmetic = solved.arithmetic;
  SetErrors(solved.errors, outcome);
  const auto state_at = [&](double tau) { return MakeState(reduction, At(problem, impact, tau)); };
  return Complete(
      detail, [&] { return MakeTimeline(impact, reduction); }, state_at, outcome);
}

}  // namespace ricochet::planar
