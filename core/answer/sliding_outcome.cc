#include "core/answer/model_outcomes.h"

namespace ricochet::sliding {

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

}  // namespace ricochet::sliding
