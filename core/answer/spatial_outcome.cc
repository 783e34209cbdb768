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

}  // namespace ricochet::spatial
