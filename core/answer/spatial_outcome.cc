#include "core/answer/model_outcomes.h"

namespace ricochet::spatial {

absl::Status MakeOutcome(const Impact& impact, const SpatialReduction& reduction, const OutcomeDetail& detail,
                         Outcome& outcome) {
  SetEnd(impact, reduction, 0.0, outcome);
  outcome.accuracy = {.relative_error = impact.error_estimate,
                      .kind = AccuracyKind::kEstimate,
                      .steps = impact.steps,
                      .right_hand_sides = impact.right_hand_sides};
  SetErrors(impact.errors, outcome);
  return Complete(
      detail, [&] { return MakeTimeline(impact, reduction); }, NoPath, outcome);
}

Approach ApproachOf(const Problem& problem) {
  return {.u0 = problem.u0, .v0 = problem.v0, .wtt = problem.w11 + problem.w22, .wnn = problem.w33};
}

}  // namespace ricochet::spatial
