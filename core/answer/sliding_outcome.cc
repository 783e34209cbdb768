#include "core/answer/model_outcomes.h"

namespace ricochet::sliding {

template <size_t kTangential>
absl::Status MakeOutcome(const Impact<kTangential>& impact, const RelativeErrors& errors,
                         const Reduction<kTangential>& reduction, const Extent& extent, Outcome& outcome) {
  SetEnd(impact, reduction, 0.0, outcome);
  outcome.accuracy = {.relative_error = errors.velocity, .kind = AccuracyKind::kBound};
  const auto state_at = [&](double tau) { return MakeState(reduction, At(impact, tau)); };
  return Complete(
      extent, [&] { return MakeTimeline(impact, reduction); }, state_at, outcome);
}

template absl::Status MakeOutcome(const Impact<1>&, const RelativeErrors&, const PlanarReduction&, const Extent&,
                                  Outcome&);
template absl::Status MakeOutcome(const Impact<2>&, const RelativeErrors&, const SpatialReduction&, const Extent&,
                                  Outcome&);

}  // namespace ricochet::sliding
