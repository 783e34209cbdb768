#include "core/models/planar_outcome.h"

#include <cmath>
#include <utility>
#include <vector>

#include "core/numerics/determinant.h"

namespace ricochet::planar {
namespace {

// Errors of the velocities, and where W is near to rank one: what the tests of this model hold it to.
constexpr double kError = 1e-13;
constexpr double kNearlySingular = 1e-6;
constexpr double kNearlySingularError = 1e-9;

State StateOf(const PlanarReduction& reduction, const Instant& instant) {
  return MakeState<1>(reduction, instant.tau, {instant.f}, {instant.u}, instant.v);
}

Accuracy AccuracyOf(const Problem& problem, const PlanarReduction& reduction, const Impact& impact) {
  Accuracy accuracy = {.kind = AccuracyKind::kEstimate};
  if (impact.regime == Regime::kSeparating) return accuracy;
  const double det = std::abs(RelativeDeterminant(problem.wtt, problem.wtn, problem.wnn));
  const double error = impact.w_rank > 1 && det < kNearlySingular ? kNearlySingularError : kError;
  accuracy.relative_error = RelativeToBefore<1>(error, reduction, {impact.u1}, impact.v1);
  return accuracy;
}

}  // namespace

Problem MakeProblem(const PlanarReduction& reduction, const Restitution& restitution,
                    const EffectiveCoefficients& effective) {
  return {.wtt = reduction.w[0],
          .wtn = reduction.w[1],
          .wnn = reduction.w[2],
          .u0 = reduction.u0[0],
          .v0 = reduction.v0,
          .mu = effective.kinetic_friction,
          .mu_static = effective.static_friction,
          .law = LawOf(restitution),
          .coefficient = effective.restitution};
}

absl::StatusOr<Outcome> MakeOutcome(const Problem& problem, const PlanarReduction& reduction,
                                    absl::Span<const double> history_at_n_s, Detail detail) {
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
  SetVelocities<1>(reduction, {impact.f1}, impact.tau1, outcome);
  outcome.contact_velocity_after = {.tangential_m_s = {impact.u1}, .normal_m_s = impact.v1};
  outcome.impulse = {
      .normal_compression_n_s = impact.tau_compression, .normal_total_n_s = impact.tau1, .tangential_n_s = {impact.f1}};
  outcome.work =
      MakeLedger(impact.work_normal_compression, impact.work_normal_restitution, impact.work_tangential_compression,
                 impact.work_tangential_restitution, impact.energy_change);
  outcome.energy_change_j = impact.energy_change;
  outcome.accuracy = AccuracyOf(problem, reduction, impact);
  if (detail == Detail::kNumbers) return outcome;
  for (size_t i = 0; i < static_cast<size_t>(impact.event_count); ++i) {
    const Instant& event = impact.events[i];
    outcome.timeline.push_back({event.kind, StateOf(reduction, event)});
  }
  const absl::Status finite = CheckFinite(outcome);
  if (!finite.ok()) return finite;
  const auto violations = CheckHistory(history_at_n_s, impact.tau1);
  if (!violations.empty()) return InvalidRequest(violations);
  for (const double tau : history_at_n_s) {
    outcome.history.push_back(StateOf(reduction, At(problem, impact, tau)));
  }
  return outcome;
}

}  // namespace ricochet::planar
