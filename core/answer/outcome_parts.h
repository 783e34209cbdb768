// Outcome parts: the parts of an outcome that all models share, which are limits, works, history and the velocities of
// the system.

#ifndef RICOCHET_CORE_ANSWER_OUTCOME_PARTS_H_
#define RICOCHET_CORE_ANSWER_OUTCOME_PARTS_H_

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "absl/status/status.h"
#include "absl/types/span.h"
#include "core/contact/reduction.h"
#include "core/models/impact_end.h"
#include "core/models/pendulum/pendulum.h"
#include "ricochet/error.h"
#include "ricochet/outcome.h"

namespace ricochet {

// A request may have at most this many history points.
inline constexpr size_t kMaxHistory = 65536;

// The part of an outcome that the caller needs.
enum class Detail {
  kNumbers,  // A sweep needs the numbers of VisitOutcomeNumbers, the regime and the limits, finite or not.
  kAll,
};

// The limits that an impact breaks, with their values.
struct LimitFindings {
  bool sharp_broken = false;
  double energetic = 0.0;
  double energetic_excess = 0.0;
  bool energy_broken = false;
  double energy_change = 0.0;
};
std::vector<BrokenLimit> BrokenLimits(const LimitFindings& findings);

// The four works with their sums and the residual against `energy_change`.
WorkLedger MakeLedger(double normal_compression, double normal_restitution, double tangential_compression,
                      double tangential_restitution, double energy_change);

// Gives a violation for each tau that is not in [0, tau1], and one if there are too many.
std::vector<Violation> CheckHistory(absl::Span<const double> taus, double tau1);

// Gives a violation if there are any, because `whom` keeps no path on which to look them up.
std::vector<Violation> RefuseHistory(absl::Span<const double> taus, const std::string& whom);

// Converts `error`, which is relative to the largest of all velocities, to one relative to the velocity before the impact.
template <size_t kTangential>
double RelativeToBefore(double error, const Reduction<kTangential>& reduction,
                        const std::array<double, kTangential>& u1, double v1) {
  double before = std::abs(reduction.v0);
  double after = std::abs(v1);
  for (size_t i = 0; i < kTangential; ++i) {
    before = std::max(before, std::abs(reduction.u0[i]));
    after = std::max(after, std::abs(u1[i]));
  }
  return error * std::max(1.0, after / before);
}

// Gives OUT_OF_RANGE that names the first number of the outcome, or of a state of its timeline, that is not finite. The
// error estimate is not checked: it is infinite if an integration did not converge.
absl::Status CheckFinite(const Outcome& outcome);

// The state of the contact at normal impulse tau, with the rates of the system's joints.
template <size_t kTangential>
State MakeState(const Reduction<kTangential>& reduction, double tau, const std::array<double, kTangential>& f,
                const std::array<double, kTangential>& u, double v) {
  State state = {.normal_impulse_n_s = tau,
                 .tangential_impulse_n_s = {f.begin(), f.end()},
                 .contact_velocity = {.tangential_m_s = {u.begin(), u.end()}, .normal_m_s = v}};
  if (reduction.coordinates == Coordinates::kRates) {
    const auto rates = reduction.After(f, tau);
    state.rates_rad_s.assign(rates.begin(), rates.end());
  }
  return state;
}

// Sets the system's own velocities after the impulse: rates_after_rad_s or bodies_after.
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
  for (auto body = after.begin(); body != after.end(); body += kLinear + kAngular) {
    outcome.bodies_after.push_back(
        {.linear_m_s = {body, body + kLinear}, .angular_rad_s = {body + kLinear, body + kLinear + kAngular}});
  }
}

// Gives a list with one entry for each tangential direction, also for a scalar.
inline std::array<double, 1> ByDirection(double t) { return {t}; }
template <size_t kTangential>
std::array<double, kTangential> ByDirection(const std::array<double, kTangential>& t) {
  return t;
}

// Makes the part of an outcome that the end of the path determines: all but its effective coefficients, accuracy,
// timeline and history.
template <size_t kTangential, typename Along>
Outcome MakeEnd(const ImpactEnd<Along>& impact, const Reduction<kTangential>& reduction, double duration = 0.0) {
  const std::array<double, kTangential> u1 = ByDirection(impact.u1);
  const std::array<double, kTangential> f1 = ByDirection(impact.f1);
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
  SetVelocities<kTangential>(reduction, f1, impact.tau1, duration, outcome);
  outcome.contact_velocity_after = {.tangential_m_s = {u1.begin(), u1.end()}, .normal_m_s = impact.v1};
  outcome.impulse = {.normal_compression_n_s = impact.tau_compression,
                     .normal_total_n_s = impact.tau1,
                     .tangential_n_s = {f1.begin(), f1.end()}};
  outcome.work =
      MakeLedger(impact.work_normal_compression, impact.work_normal_restitution, impact.work_tangential_compression,
                 impact.work_tangential_restitution, impact.energy_change);
  outcome.energy_change_j = impact.energy_change;
  return outcome;
}

// The state at an instant, which has the members of planar::Instant or of spatial::Instant.
template <size_t kTangential, typename SomeInstant>
State MakeState(const Reduction<kTangential>& reduction, const SomeInstant& instant) {
  return MakeState<kTangential>(reduction, instant.tau, ByDirection(instant.f), ByDirection(instant.u), instant.v);
}

// The events of an impact; none if the contact separates.
template <size_t kTangential, typename SomeImpact>
std::vector<Event> MakeTimeline(const SomeImpact& impact, const Reduction<kTangential>& reduction) {
  std::vector<Event> timeline;
  if (impact.regime == Regime::kSeparating) return timeline;
  for (size_t i = 0; i < static_cast<size_t>(impact.event_count); ++i) {
    timeline.push_back({impact.events[i].kind, MakeState(reduction, impact.events[i])});
  }
  return timeline;
}

}  // namespace ricochet

#endif  // RICOCHET_CORE_ANSWER_OUTCOME_PARTS_H_
