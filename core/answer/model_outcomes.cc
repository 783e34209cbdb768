#include "core/answer/model_outcomes.h"

#include "core/plan/arithmetic.h"

namespace ricochet {

namespace planar {

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

}  // namespace planar

namespace sliding {

template <size_t kTangential>
absl::Status MakeOutcome(const Problem<kTangential>& problem, const Impact<kTangential>& impact,
                         const RelativeErrors& errors, const Reduction<kTangential>& reduction,
                         const OutcomeDetail& detail, Outcome& outcome) {
  SetEnd(impact, reduction, 0.0, outcome);
  SetErrors(NumberErrorsOf(problem, impact), outcome);
  outcome.accuracy = {.relative_error = errors.velocity, .kind = AccuracyKind::kBound};
  const auto state_at = [&](double tau) { return MakeState(reduction, At(impact, tau)); };
  return Complete(
      detail, [&] { return MakeTimeline(impact, reduction); }, state_at, outcome);
}

template absl::Status MakeOutcome(const Problem<1>&, const Impact<1>&, const RelativeErrors&, const PlanarReduction&,
                                  const OutcomeDetail&, Outcome&);
template absl::Status MakeOutcome(const Problem<2>&, const Impact<2>&, const RelativeErrors&, const SpatialReduction&,
                                  const OutcomeDetail&, Outcome&);

}  // namespace sliding

namespace spatial {

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

}  // namespace spatial

namespace finite_duration {

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

}  // namespace finite_duration

}  // namespace ricochet
