#include "core/answer/model_outcomes.h"

namespace ricochet::sliding {
namespace {

template <size_t kTangential>
absl::Status MakeOutcomeOf(const Impact<kTangential>& impact, const RelativeErrors& errors,
                           const Reduction<kTangential>& reduction, const Extent& extent, Outcome& outcome) {
  SetEnd(impact, reduction, 0.0, outcome);
  outcome.accuracy = {.relative_error = errors.velocity, .kind = AccuracyKind::kBound};
  const auto state_at = [&](double tau) { return MakeState(reduction, At(impact, tau)); };
  return Complete(
      extent, [&] { return MakeTimeline(impact, reduction); }, state_at, outcome);
}

}  // namespace

template <size_t kTangential>
absl::Status MakeOutcome(const Problem<kTangential>& problem, const Reduction<kTangential>& reduction,
                         const Extent& extent, Outcome& outcome) {
  return MakeOutcomeOf(Solve(problem), ErrorsOf(problem), reduction, extent, outcome);
}

template <size_t kTangential>
absl::Status MakeFrictionlessOutcome(const Problem<kTangential>& problem, const Reduction<kTangential>& reduction,
                                     const Extent& extent, Outcome& outcome) {
  return MakeOutcomeOf(SolveFrictionless(problem), FrictionlessErrorsOf(problem), reduction, extent, outcome);
}

template absl::Status MakeOutcome(const Problem<1>&, const PlanarReduction&, const Extent&, Outcome&);
template absl::Status MakeOutcome(const Problem<2>&, const SpatialReduction&, const Extent&, Outcome&);
template absl::Status MakeFrictionlessOutcome(const Problem<1>&, const PlanarReduction&, const Extent&, Outcome&);
template absl::Status MakeFrictionlessOutcome(const Problem<2>&, const SpatialReduction&, const Extent&, Outcome&);

}  // namespace ricochet::sliding
