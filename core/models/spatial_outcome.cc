#include "core/models/spatial_outcome.h"

namespace ricochet::spatial {

Problem MakeProblem(const SpatialReduction& reduction, const Restitution& restitution,
                    const EffectiveCoefficients& effective, double tolerance) {
  const auto& [w11, w12, w13, w22, w23, w33] = reduction.w;
  return {.w11 = w11,
          .w12 = w12,
          .w13 = w13,
          .w22 = w22,
          .w23 = w23,
          .w33 = w33,
          .u0 = reduction.u0,
          .v0 = reduction.v0,
          .mu = effective.kinetic_friction,
          .mu_static = effective.static_friction,
          .law = LawOf(restitution),
          .coefficient = effective.restitution,
          .tolerance = tolerance};
}

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
