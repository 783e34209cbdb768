#include "core/models/spatial_outcome.h"

#include <utility>
#include <vector>

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
  Outcome outcome;
  outcome.regime = impact.regime;
  outcome.broken_limits = BrokenLimits({.sharp_broken = impact.sharp_limit_broken,
                                        .energetic = impact.energetic,
                                        .energetic_excess = impact.energetic_excess,
                                        .energy_broken = impact.energy_limit_broken,
                                        .energy_change = impact.energy_change});
  outcome.admissible = outcome.broken_limits.empty();
  outcome.w_rank = impact.w_rank;
  outcome.coefficients = {.newton = impact.newton,
                          .poisson = impact.poisson,
                          .energetic = impact.energetic,
                          .tangential = impact.tangential};
  SetVelocities<2>(reduction, impact.f1, impact.tau1, outcome);
  outcome.contact_velocity_after = {.tangential_m_s = {impact.u1.begin(), impact.u1.end()}, .normal_m_s = impact.v1};
  outcome.impulse = {.normal_compression_n_s = impact.tau_compression,
                     .normal_total_n_s = impact.tau1,
                     .tangential_n_s = {impact.f1.begin(), impact.f1.end()}};
  outcome.work =
      MakeLedger(impact.work_normal_compression, impact.work_normal_restitution, impact.work_tangential_compression,
                 impact.work_tangential_restitution, impact.energy_change);
  outcome.energy_change_j = impact.energy_change;
  outcome.accuracy = {.relative_error = impact.error_estimate,
                      .kind = AccuracyKind::kEstimate,
                      .steps = impact.steps,
                      .right_hand_sides = impact.right_hand_sides};
  if (detail == Detail::kNumbers) return outcome;
  for (size_t i = 0; impact.regime != Regime::kSeparating && i < static_cast<size_t>(impact.event_count); ++i) {
    const Instant& event = impact.events[i];
    outcome.timeline.push_back({event.kind, MakeState<2>(reduction, event.tau, event.f, event.u, event.v)});
  }
  const absl::Status finite = CheckFinite(outcome);
  if (!finite.ok()) return finite;
  return outcome;
}

}  // namespace ricochet::spatial
