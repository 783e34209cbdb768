#include <cmath>
#include <vector>

#include "absl/strings/str_cat.h"
#include "core/answer/model_outcomes.h"
#include "core/scene/numbers.h"

namespace ricochet::compliant {

static_assert(kLeastRatioSquared == kLeastTangentialRatioSquared);

namespace {

Event MakeEvent(EventKind kind, const Section& section, const PlanarReduction& reduction) {
  return {kind, MakeState(reduction, section)};
}

// Adds the change of the friction state that begins a section, if it is one. A smooth contact has none.
void AddFrictionEvent(const Problem& problem, const Section& before, const Section& section,
                      const PlanarReduction& reduction, std::vector<Event>& timeline) {
  if (problem.contact.mu == 0.0 || section.friction == before.friction) return;
  const EventKind kind = section.friction == FrictionState::kStick ? EventKind::kStickStarts : EventKind::kSlipStarts;
  timeline.push_back(MakeEvent(kind, section, reduction));
}

std::vector<Event> TimelineOf(const Problem& problem, const Impact& impact, const PlanarReduction& reduction) {
  std::vector<Event> timeline;
  if (impact.sections.empty()) return timeline;
  timeline.push_back(MakeEvent(EventKind::kStart, impact.sections.front(), reduction));
  bool compresses = impact.tau_compression > 0.0;
  const auto add_end_of_compression = [&](const Section& section) {
    if (!compresses || section.tau < impact.tau_compression) return;
    compresses = false;
    timeline.push_back(MakeEvent(EventKind::kCompressionEnds, section, reduction));
  };
  for (size_t i = 1; i < impact.sections.size(); ++i) {
    add_end_of_compression(impact.sections[i]);
    AddFrictionEvent(problem, impact.sections[i - 1], impact.sections[i], reduction, timeline);
  }
  const Section end = {.tau = impact.tau1, .f = impact.f1, .u = impact.u1, .v = impact.v1};
  if (impact.termination == Termination::kConverged) add_end_of_compression(end);  // Without restitution.
  timeline.push_back(MakeEvent(EventKind::kRestitutionEnds, end, reduction));
  return timeline;
}

void CutTimeline(Outcome& outcome) {
  std::vector<Event>& timeline = outcome.timeline;
  if (timeline.size() <= kMostEvents) return;
  timeline.erase(timeline.begin() + kMostEvents - 1, timeline.end() - 1);
  outcome.notes.push_back(
      {.kind = NoteKind::kTimelineCut,
       .path = "timeline",
       .text = absl::StrCat("The contact sticks and slips so often that the timeline has the first ", kMostEvents - 1,
                            " events and the end alone.")});
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
  absl::Status status = Complete(
      detail, [&] { return TimelineOf(problem, impact, reduction); }, NoPath, outcome);
  CutTimeline(outcome);
  return status;
}

}  // namespace ricochet::compliant
