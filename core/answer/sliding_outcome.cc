#include "core/answer/sliding_outcome.h"

namespace ricochet::sliding {
namespace {

template <size_t kTangential>
absl::StatusOr<Outcome> MakeOutcomeOf(const Impact<kTangential>& impact, const RelativeErrors& errors,
                                      const Reduction<kTangential>& reduction, absl::Span<const double> history_at_n_s,
                                      Detail detail) {
  Outcome outcome = MakeEnd(impact, reduction);
  outcome.accuracy = {.relative_error = errors.velocity, .kind = AccuracyKind::kBound};
  if (detail == Detail::kNumbers) return outcome;
  outcome.timeline = MakeTimeline(impact, reduction);
  const absl::Status finite = CheckFinite(outcome);
  if (!finite.ok()) return finite;
  const auto violations = CheckHistory(history_at_n_s, impact.tau1);
  if (!violations.empty()) return InvalidRequest(violations);
  for (const double tau : history_at_n_s) outcome.history.push_back(MakeState(reduction, At(impact, tau)));
  return outcome;
}

}  // namespace

template <size_t kTangential>
absl::StatusOr<Outcome> MakeOutcome(const Problem<kTangential>& problem, const Reduction<kTangential>& reduction,
                                    absl::Span<const double> history_at_n_s, Detail detail) {
  return MakeOutcomeOf(Solve(problem), ErrorsOf(problem), reduction, history_at_n_s, detail);
}

template <size_t kTangential>
absl::StatusOr<Outcome> MakeFrictionlessOutcome(const Problem<kTangential>& problem,
                                                const Reduction<kTangential>& reduction,
                                                absl::Span<const double> history_at_n_s, Detail detail) {
  return MakeOutcomeOf(SolveFrictionless(problem), FrictionlessErrorsOf(problem), reduction, history_at_n_s, detail);
}

template absl::StatusOr<Outcome> MakeOutcome(const Problem<1>&, const PlanarReduction&, absl::Span<const double>,
                                             Detail);
template absl::StatusOr<Outcome> MakeOutcome(const Problem<2>&, const SpatialReduction&, absl::Span<const double>,
                                             Detail);
template absl::StatusOr<Outcome> MakeFrictionlessOutcome(const Problem<1>&, const PlanarReduction&,
                                                         absl::Span<const double>, Detail);
template absl::StatusOr<Outcome> MakeFrictionlessOutcome(const Problem<2>&, const SpatialReduction&,
                                                         absl::Span<const double>, Detail);

}  // namespace ricochet::sliding
