#include "core/answer/finite_duration_outcome.h"

namespace ricochet::finite_duration {

absl::StatusOr<Outcome> MakeOutcome(const Problem& problem, const PlanarReduction& reduction,
                                    absl::Span<const double> history_at_n_s, absl::FunctionRef<bool()> stopped,
                                    Detail detail) {
  if (auto violations = RefuseHistory(history_at_n_s, "an impact that takes time; force_intervals asks for its forces");
      !violations.empty()) {
    return InvalidRequest(violations);
  }
  const Impact impact = Solve(problem, stopped);
  if (impact.stopped) return absl::CancelledError("the impact was stopped by its caller");
  Outcome outcome = MakeEnd(impact, reduction, impact.contact.duration_s);
  outcome.work.friction_dissipation_j = impact.friction_dissipation;
  outcome.work.tangential_spring_j = impact.spring_energy;
  outcome.accuracy = {.relative_error = impact.error_estimate,
                      .kind = AccuracyKind::kEstimate,
                      .steps = impact.steps,
                      .right_hand_sides = impact.right_hand_sides};
  outcome.contact = impact.contact;
  if (detail == Detail::kNumbers) return outcome;
  outcome.timeline = impact.events;
  const absl::Status finite = CheckFinite(outcome);
  if (!finite.ok()) return finite;
  return outcome;
}

}  // namespace ricochet::finite_duration
