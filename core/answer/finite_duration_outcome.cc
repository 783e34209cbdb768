#include "core/answer/model_outcomes.h"

namespace ricochet::finite_duration {

absl::Status MakeOutcome(const Problem& problem, const PlanarReduction& reduction, const OutcomeDetail& detail,
                         absl::FunctionRef<bool()> stopped, Outcome& outcome) {
  const Impact impact = Solve(problem, stopped);
  if (impact.stopped) return absl::CancelledError("the impact was stopped by its caller");
  SetEnd(impact, reduction, impact.contact.duration_s, outcome);
  outcome.work.friction_dissipation_j = impact.friction_dissipation;
  outcome.work.tangential_spring_j = impact.spring_energy;
  outcome.accuracy = {.relative_error = impact.error_estimate,
                      .kind = AccuracyKind::kEstimate,
                      .steps = impact.steps,
                      .right_hand_sides = impact.right_hand_sides};
  SetErrors(impact.errors, outcome);
  if (impact.regime != Regime::kSeparating) outcome.contact = impact.contact;
  const auto timeline = [&] {
    std::vector<Event> events;
    for (const TimedInstant& at : impact.events) {
      events.push_back({at.kind, MakeState<1>(reduction, at.tau, {at.f}, {at.u}, at.v, at.time_s)});
    }
    return events;
  };
  return Complete(detail, timeline, NoPath, outcome);
}

}  // namespace ricochet::finite_duration
