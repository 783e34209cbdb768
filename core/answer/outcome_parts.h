// Outcome parts: the parts of an outcome that all models share, which are limits, works, history and the velocities of
// the system.

#ifndef RICOCHET_CORE_ANSWER_OUTCOME_PARTS_H_
#define RICOCHET_CORE_ANSWER_OUTCOME_PARTS_H_

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "absl/functional/function_ref.h"
#include "absl/status/status.h"
#include "absl/types/span.h"
#include "core/contact/reduction.h"
#include "core/models/impact_end.h"
#include "core/models/impact_errors.h"
#include "ricochet/outcome.h"

namespace ricochet {

// The parts of an outcome that a caller wants. The rules of histories hold already, but for the
// range of the impulses.
struct OutcomeDetail {
  // A sweep needs the numbers of VisitOutcomeNumbers, the regime and the limits alone, finite or not.
  bool numbers_only = false;
  absl::Span<const double> history_at_n_s;
  int64_t history_intervals = 0;
  int64_t force_intervals = 0;  // A history in time has so many (finite_duration::Problem::intervals).
};

// The limits that an impact breaks, with their values.
struct LimitFindings {
  bool sharp_broken = false;
  double energetic = 0.0;
  double energetic_excess = 0.0;
  bool energy_broken = false;
  double energy_change = 0.0;
  bool friction_broken = false;
  double friction_work = 0.0;
};
// Sets the broken limits, and with them whether the outcome is admissible.
void SetLimits(const LimitFindings& findings, Outcome& outcome);

// The four works with their sums and the residual against `energy_change`.
WorkLedger MakeLedger(double normal_compression, double normal_restitution, double tangential_compression,
                      double tangential_restitution, double energy_change);

// Sets the errors that are known.
void SetErrors(const ImpactErrors& errors, Outcome& outcome);

// Approach holds the numbers that sizes and errors are relative to.
struct Approach {
  std::array<double, 2> u0 = {};  // One component in a plane.
  double v0 = 0.0;
  double wtt = 0.0;  // The trace of Wtt.
  double wnn = 0.0;

  double Speed() const { return std::max({std::fabs(u0[0]), std::fabs(u0[1]), std::fabs(v0)}); }
};

// Adds to the errors what effects change that the plan leaves out: `neglected`, over |v0|, in each velocity and in each
// impulse times its mobility, and what follows for the tangential coefficient and the energy. The errors of the phases
// become unset: no bound is known of them.
void AddNeglected(double neglected, const Approach& approach, Outcome& outcome);

// Marks an outcome that has an end as less accurate if its error exceeds `tolerance`; 0 stands for any error.
void CompareWithTolerance(double tolerance, Outcome& outcome);

// Unsets the numbers of the two phases and their errors, of which an impact law knows nothing.
void UnsetPhases(Outcome& outcome);

// Gives OUT_OF_RANGE that names the first number of the outcome, or of a state of its timeline, that is not finite. An
// error is not checked: it is infinite where nothing is known (MayBeInfinite).
absl::Status CheckFinite(const Outcome& outcome);

// Gives INVALID_ARGUMENT for each impulse of a history that is not in [0, tau1], else adds the history.
absl::Status AddHistory(const OutcomeDetail& detail, absl::FunctionRef<State(double)> state_at, Outcome& outcome);

// Completes an outcome whose numbers are set: every model ends so. `timeline()` gives the events, `state_at(tau)` the
// state at a normal impulse.
// Errors: OUT_OF_RANGE of CheckFinite, INVALID_ARGUMENT of AddHistory. With numbers_only there are none.
template <typename Timeline>
absl::Status Complete(const OutcomeDetail& detail, const Timeline& timeline, absl::FunctionRef<State(double)> state_at,
                      Outcome& outcome) {
  if (detail.numbers_only) return absl::OkStatus();
  outcome.timeline = timeline();
  absl::Status finite = CheckFinite(outcome);
  return finite.ok() ? AddHistory(detail, state_at, outcome) : finite;
}

// Stands in for the state_at of a model that keeps no path. The checks of a request refuse histories of its scenes.
State NoPath(double tau);

// Gives a list with one entry for each tangential direction, also for a scalar.
inline std::array<double, 1> ByDirection(double t) { return {t}; }
template <size_t kTangential>
std::array<double, kTangential> ByDirection(const std::array<double, kTangential>& t) {
  return t;
}

// The state of the contact at normal impulse tau, with the rates of the system's joints, after finite forces have acted
// for `duration` in s.
template <size_t kTangential>
State MakeState(const Reduction<kTangential>& reduction, double tau, const std::array<double, kTangential>& f,
                const std::array<double, kTangential>& u, double v, double duration = 0.0) {
  State state = {.normal_impulse_n_s = tau,
                 .tangential_impulse_n_s = {f.begin(), f.end()},
                 .contact_velocity = {.tangential_m_s = {u.begin(), u.end()}, .normal_m_s = v}};
  if (reduction.coordinates == Coordinates::kRates) {
    const auto rates = reduction.After(f, tau, duration);
    state.rates_rad_s.assign(rates.begin(), rates.end());
  }
  return state;
}

// The state at an instant, which has the members of ImpactInstant.
template <size_t kTangential, typename SomeInstant>
State MakeState(const Reduction<kTangential>& reduction, const SomeInstant& instant) {
  return MakeState<kTangential>(reduction, instant.tau, ByDirection(instant.f), ByDirection(instant.u), instant.v);
}

// Sets the system's own velocities after the impulse: rates_after_rad_s, bodies_after, or rates_after with the momentum
// that a mechanism takes, whose errors count as not known.
template <size_t kTangential>
void SetVelocities(const Reduction<kTangential>& reduction, const std::array<double, kTangential>& f, double tau1,
                   double duration, Outcome& outcome) {
  constexpr size_t kLinear = kTangential + 1;
  constexpr size_t kAngular = kTangential == 1 ? 1 : 3;
  if (reduction.coordinates == Coordinates::kNone) return;
  const auto after = reduction.After(f, tau1, duration);
  if (reduction.coordinates == Coordinates::kRates) {
    outcome.rates_after_rad_s.assign(after.begin(), after.end());
    return;
  }
  if (reduction.coordinates == Coordinates::kAny) {
    outcome.rates_after.assign(after.begin(), after.end());
    outcome.momentum_change.resize(after.size());
    const double* row = reduction.momentum.data();
    for (double& momentum : outcome.momentum_change) {
      momentum = row[kTangential] * tau1;
      for (size_t i = 0; i < kTangential; ++i) momentum += row[i] * f[i];
      row += kTangential + 1;
    }
    outcome.errors.rates_after.assign(after.size(), ImpactErrors::kUnknown);
    outcome.errors.momentum_change.assign(after.size(), ImpactErrors::kUnknown);
    return;
  }
  outcome.bodies_after.reserve(after.size() / (kLinear + kAngular));
  for (auto body = after.begin(); body != after.end(); body += kLinear + kAngular) {
    BodyVelocity& velocity = outcome.bodies_after.emplace_back();
    velocity.linear_m_s = Components(body, body + kLinear);
    velocity.angular_rad_s = Components(body + kLinear, body + kLinear + kAngular);
  }
}

// Sets the part of an outcome that the end of the path determines: all but its effective coefficients, accuracy,
// timeline and history.
template <size_t kTangential, typename Along>
void SetEnd(const ImpactEnd<Along>& impact, const Reduction<kTangential>& reduction, double duration,
            Outcome& outcome) {
  const std::array<double, kTangential> u1 = ByDirection(impact.u1);
  const std::array<double, kTangential> f1 = ByDirection(impact.f1);
  outcome.regime = impact.regime;
  outcome.termination = impact.termination;
  SetLimits({.sharp_broken = impact.sharp_limit_broken,
             .energetic = impact.energetic,
             .energetic_excess = impact.energetic_excess,
             .energy_broken = impact.energy_limit_broken,
             .energy_change = impact.energy_change,
             .friction_broken = impact.friction_limit_broken,
             .friction_work = impact.work_tangential_compression + impact.work_tangential_restitution},
            outcome);
  outcome.w_rank = impact.w_rank;
  outcome.coefficients = {.newton = impact.newton,
                          .poisson = impact.poisson,
                          .energetic = impact.energetic,
                          .tangential = impact.tangential};
  SetVelocities<kTangential>(reduction, f1, impact.tau1, duration, outcome);
  outcome.contact_velocity_after.tangential_m_s = Components(u1.begin(), u1.end());
  outcome.contact_velocity_after.normal_m_s = impact.v1;
  outcome.impulse.normal_compression_n_s = impact.tau_compression;
  outcome.impulse.normal_total_n_s = impact.tau1;
  outcome.impulse.tangential_n_s = Components(f1.begin(), f1.end());
  outcome.work =
      MakeLedger(impact.work_normal_compression, impact.work_normal_restitution, impact.work_tangential_compression,
                 impact.work_tangential_restitution, impact.energy_change);
  outcome.energy_change_j = impact.energy_change;
}

// The events of an impact; none if the contact separates.
template <size_t kTangential, typename SomeImpact>
std::vector<Event> MakeTimeline(const SomeImpact& impact, const Reduction<kTangential>& reduction) {
  std::vector<Event> timeline;
  if (impact.regime == Regime::kSeparating) return timeline;
  timeline.reserve(static_cast<size_t>(impact.event_count));
  for (size_t i = 0; i < static_cast<size_t>(impact.event_count); ++i) {
    timeline.push_back({impact.events[i].kind, MakeState(reduction, impact.events[i])});
  }
  return timeline;
}

}  // namespace ricochet

#endif  // RICOCHET_CORE_ANSWER_OUTCOME_PARTS_H_
