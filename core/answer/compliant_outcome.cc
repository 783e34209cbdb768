#include <cmath>
#include <vector>

#include "core/answer/model_outcomes.h"
#include "core/scene/numbers.h"

namespace ricochet::compliant {

static_assert(kLeastRatioSquared == kLeastTangentialRatioSquared);

namespace {

Event MakeEvent(EventKind kind, const Section& section, const PlanarReduction& reduction) {
  return {kind, MakeState(reduction, section)};
}

// Adds the events that begin `section`, which follows a section in the friction state `before`.
void AddEvents(const Section& section, FrictionState before, double tau_compression, const PlanarReduction& reduction,
               std::vector<Event>& timeline) {
  if (section.tau == tau_compression) {
    timeline.push_back(MakeEvent(EventKind::kCompressionEnds, section, reduction));
  }
  if (section.friction == before) return;
  const EventKind kind = section.friction == FrictionState::kStick ? EventKind::kStickStarts : EventKind::kSlipStarts;
  timeline.push_back(MakeEvent(kind, section, reduction));
}

std::vector<Event> TimelineOf(const Impact& impact, const PlanarReduction& reduction) {
  std::vector<Event> timeline;
  if (impact.sections.empty()) return timeline;
  timeline.push_back(MakeEvent(EventKind::kStart, impact.sections.front(), reduction));
  for (size_t i = 1; i < impact.sections.size() && timeline.size() + 2 < kMostEvents; ++i) {
    AddEvents(impact.sections[i], impact.sections[i - 1].friction, impact.tau_compression, reduction, timeline);
  }
  const Section end = {.tau = impact.tau1, .f = impact.f1, .u = impact.u1, .v = impact.v1};
  timeline.push_back(MakeEvent(EventKind::kRestitutionEnds, end, reduction));
  return timeline;
}

}  // namespace

absl::Status MakeOutcome(const Problem& problem, const PlanarReduction& reduction, const OutcomeDetail& detail,
                         Outcome& outcome) {
  const Impact impact = Solve(problem);
  SetEnd(impact, reduction, 0.0, outcome);
  outcome.work.normal_total_j = impact.work_normal;
  outcome.work.friction_dissipation_j = impact.friction_dissipation;
  outcome.work.tangential_spring_j = impact.spring_energy;
  outcome.accuracy = {.relative_error = impact.error_estimate, .kind = AccuracyKind::kEstimate};
  SetErrors(impact.errors, outcome);
  // If the path overflows, not even the regime is known, so that the outcome is checked in every case.
  if (!std::isfinite(impact.u1)) return CheckFinite(outcome);
  return Complete(
      detail, [&] { return TimelineOf(impact, reduction); }, NoPath, outcome);
}

}  // namespace ricochet::compliant
