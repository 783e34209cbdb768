#include "core/answer/spatial_outcome.h"

namespace ricochet::spatial {

absl::StatusOr<Outcome> MakeOutcome(const Problem& problem, const SpatialReduction& reduction,
                                    absl::Span<const double> history_at_n_s, Detail detail) {
  if (auto violations = RefuseHistory(history_at_n_s, "a system in space"); !violations.empty()) {
    return InvalidRequest(violations);
  }
  const Impact impact = Solve(problem);
  Outcome outcome = MakeEnd(impact, reduction);
  outcome.accuracy = {.relative_error = impact.error_estimate,
                      .kind = AccuracyKind::kEstimate,
                      .steps = impact.steps,
                      .right_hand_sides = impact.right_hand_sides};
  if (detail == Detail::kNumbers) return outcome;
  outcome.timeline = MakeTimeline(impact, reduction);
  const absl::Status finite = CheckFinite(outcome);
  if (!finite.ok()) return finite;
  return outcome;
}

}  // namespace ricochet::spatial
