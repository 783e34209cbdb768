#include "core/answer/outcome_parts.h"

#include <numeric>
#include <optional>
#include <string>

#include "absl/strings/str_cat.h"
#include "core/base/decimal.h"
#include "core/base/invariant.h"
#include "ricochet/error.h"
#include "ricochet/outcome_numbers.h"

namespace ricochet {
namespace {

double Sum(const Components& values) { return std::accumulate(values.begin(), values.end(), 0.0); }

bool AllFinite(const Components& values) {
  return std::all_of(values.begin(), values.end(), [](double value) { return std::isfinite(value); });
}

// A finite sum of the numbers proves at little cost that each is finite. Finite numbers may have an infinite sum, and
// errors may be infinite.
double Sum(const State& state) {
  return Sum(state.contact_velocity.tangential_m_s) + Sum(state.tangential_impulse_n_s) + Sum(state.rates_rad_s) +
         state.normal_impulse_n_s + state.contact_velocity.normal_m_s;
}
double Sum(const Outcome& outcome) {
  double sum = 0.0;
  VisitOutcomeNumbers(outcome, [&sum](const NumberPath& /*path*/, double number) { sum += number; });
  for (const Event& event : outcome.timeline) sum += Sum(event.state);
  return sum;
}

// The path of the first number that is not finite but must be.
std::optional<std::string> OverflowIn(const Outcome& outcome) {
  std::optional<NumberPath> wrong;
  VisitOutcomeNumbers(outcome, [&wrong](const NumberPath& path, double number) {
    if (!wrong.has_value() && !MayBeInfinite(path) && !std::isfinite(number)) wrong = path;
  });
  if (!wrong.has_value()) return std::nullopt;
  return wrong->Text();
}

// The path, within a state, of its first number that is not finite; empty if there is none.
std::string OverflowIn(const State& state) {
  if (!std::isfinite(state.contact_velocity.normal_m_s)) return "contact_velocity.normal_m_s";
  const Components& tangential = state.contact_velocity.tangential_m_s;
  for (size_t i = 0; i < tangential.size(); ++i) {
    if (!std::isfinite(tangential[i])) return absl::StrCat("contact_velocity.tangential_m_s[", i, "]");
  }
  if (!std::isfinite(state.normal_impulse_n_s)) return "normal_impulse_n_s";
  if (!AllFinite(state.tangential_impulse_n_s)) return "tangential_impulse_n_s";
  return AllFinite(state.rates_rad_s) ? "" : "rates_rad_s";
}

// The ends of equal steps of tau from 0 to tau1.
double EqualStep(double tau1, int64_t i, int64_t intervals) {
  return tau1 * (static_cast<double>(i) / static_cast<double>(intervals));
}

std::vector<Violation> CheckRange(absl::Span<const double> taus, double tau1) {
  std::vector<Violation> violations;
  for (size_t i = 0; i < taus.size(); ++i) {
    if (taus[i] >= 0.0 && taus[i] <= tau1) continue;
    violations.push_back(MakeViolation(absl::StrCat("history_at_n_s[", i, "]"), taus[i],
                                       absl::StrCat("be in [0, tau1 = ", ShortestDecimal(tau1), "]")));
  }
  return violations;
}

// Checks number by number. It is kept out of the function that adds them up, which every answer calls.
[[gnu::noinline]] absl::Status CheckEach(const Outcome& outcome) {
  const std::optional<std::string> path = OverflowIn(outcome);
  if (path.has_value()) return OutputOverflow("outcome." + *path);
  for (size_t i = 0; i < outcome.timeline.size(); ++i) {
    const std::string in_state = OverflowIn(outcome.timeline[i].state);
    if (!in_state.empty()) return OutputOverflow(absl::StrCat("outcome.timeline[", i, "].state.", in_state));
  }
  return absl::OkStatus();
}

}  // namespace

void SetLimits(const LimitFindings& findings, Outcome& outcome) {
  if (findings.sharp_broken) {
    outcome.broken_limits.push_back(
        {.kind = LimitKind::kSharp, .value = findings.energetic, .limit = 1.0, .excess = findings.energetic_excess});
  }
  if (findings.energy_broken) {
    outcome.broken_limits.push_back(
        {.kind = LimitKind::kEnergy, .value = findings.energy_change, .limit = 0.0, .excess = findings.energy_change});
  }
  if (findings.friction_broken) {
    outcome.broken_limits.push_back({.kind = LimitKind::kFriction,
                                     .value = findings.friction_work,
                                     .limit = 0.0,
                                     .excess = findings.friction_work});
  }
  outcome.admissible = outcome.broken_limits.empty();
}

WorkLedger MakeLedger(double normal_compression, double normal_restitution, double tangential_compression,
                      double tangential_restitution, double energy_change) {
  return {.normal_compression_j = normal_compression,
          .normal_restitution_j = normal_restitution,
          .tangential_compression_j = tangential_compression,
          .tangential_restitution_j = tangential_restitution,
          .normal_total_j = normal_compression + normal_restitution,
          .tangential_total_j = tangential_compression + tangential_restitution,
          .friction_dissipation_j = 0.0 - (tangential_compression + tangential_restitution),
          .residual_j = normal_compression + normal_restitution + tangential_compression + tangential_restitution -
                        energy_change};
}

void SetErrors(const ImpactErrors& errors, Outcome& outcome) {
  const auto set = [](double error, std::optional<double>& place) {
    if (std::isfinite(error)) place = error;
  };
  NumberErrors& out = outcome.errors;
  set(errors.newton, out.newton);
  set(errors.poisson, out.poisson);
  set(errors.energetic, out.energetic);
  set(errors.tangential, out.tangential);
  set(errors.u, out.tangential_m_s);
  set(errors.v, out.normal_m_s);
  set(errors.tau_compression, out.normal_compression_n_s);
  set(errors.tau, out.normal_total_n_s);
  set(errors.f, out.tangential_n_s);
  set(errors.work_normal_compression, out.normal_compression_j);
  set(errors.work_normal_restitution, out.normal_restitution_j);
  set(errors.work_tangential_compression, out.tangential_compression_j);
  set(errors.work_tangential_restitution, out.tangential_restitution_j);
  set(errors.energy_change, out.energy_change_j);
}

// Bounds the change of the energy f.(u0 + u1)/2 + tau (v0 + v1)/2 if each velocity changes by `change`.
static double NeglectedEnergy(double change, double of_tau, double of_f, const Approach& before,
                              const Outcome& outcome) {
  const ContactVelocity& after = outcome.contact_velocity_after;
  double sum = of_tau * std::fabs(before.v0 + after.normal_m_s) + (outcome.impulse.normal_total_n_s + of_tau) * change;
  for (size_t i = 0; i < after.tangential_m_s.size(); ++i) {
    sum += of_f * std::fabs(before.u0[i] + after.tangential_m_s[i]) +
           (std::fabs(outcome.impulse.tangential_n_s[i]) + of_f) * change;
  }
  return 0.5 * sum;
}

void AddNeglected(double neglected, const Approach& approach, Outcome& outcome) {
  if (!(neglected > 0.0)) return;
  const double change = neglected * std::fabs(approach.v0);
  outcome.accuracy.relative_error += change / approach.Speed();
  const NumberErrors without = outcome.errors;
  NumberErrors& errors = outcome.errors;
  errors = {.rates_after = without.rates_after, .momentum_change = without.momentum_change};
  const auto add = [](const std::optional<double>& error, double more, std::optional<double>& place) {
    if (error.has_value() && std::isfinite(more)) place = *error + more;
  };
  add(without.tangential_m_s, change, errors.tangential_m_s);
  add(without.normal_m_s, change, errors.normal_m_s);
  add(without.newton, neglected, errors.newton);
  const double of_tau = change / approach.wnn, of_f = change / approach.wtt;
  add(without.normal_total_n_s, of_tau, errors.normal_total_n_s);
  add(without.tangential_n_s, of_f, errors.tangential_n_s);
  const double tau = outcome.impulse.normal_total_n_s, least_tau = tau - of_tau;
  const double ratio = std::fabs(outcome.coefficients.tangential);
  if (least_tau > 0.0) add(without.tangential, (of_f + ratio * of_tau) / least_tau, errors.tangential);
  add(without.energy_change_j, NeglectedEnergy(change, of_tau, of_f, approach, outcome), errors.energy_change_j);
}

void CompareWithTolerance(double tolerance, Outcome& outcome) {
  // A claim that is no number is within no tolerance.
  const bool exceeds = tolerance > 0.0 && !(outcome.accuracy.relative_error <= tolerance);
  if (exceeds && outcome.termination == Termination::kConverged) outcome.termination = Termination::kLessAccurate;
}

void UnsetPhases(Outcome& outcome) {
  outcome.coefficients.poisson = outcome.coefficients.energetic = std::nullopt;
  outcome.impulse.normal_compression_n_s = std::nullopt;
  outcome.work.normal_compression_j = outcome.work.normal_restitution_j = std::nullopt;
  outcome.work.tangential_compression_j = outcome.work.tangential_restitution_j = std::nullopt;
  NumberErrors& errors = outcome.errors;
  errors.poisson = errors.energetic = errors.normal_compression_n_s = std::nullopt;
  errors.normal_compression_j = errors.normal_restitution_j = std::nullopt;
  errors.tangential_compression_j = errors.tangential_restitution_j = std::nullopt;
}

absl::Status CheckFinite(const Outcome& outcome) {
  return std::isfinite(Sum(outcome)) ? absl::OkStatus() : CheckEach(outcome);
}

absl::Status AddHistory(const OutcomeDetail& detail, absl::FunctionRef<State(double)> state_at, Outcome& outcome) {
  if (detail.history_at_n_s.empty() && detail.history_intervals == 0) return absl::OkStatus();
  const double tau1 = outcome.impulse.normal_total_n_s;
  const std::vector<Violation> violations = CheckRange(detail.history_at_n_s, tau1);
  if (!violations.empty()) return InvalidRequest(violations);
  for (const double tau : detail.history_at_n_s) outcome.history.push_back(state_at(tau));
  const int64_t intervals = detail.history_intervals;
  for (int64_t i = 0; intervals > 0 && i <= intervals; ++i) {
    outcome.history.push_back(state_at(EqualStep(tau1, i, intervals)));
  }
  return absl::OkStatus();
}

State NoPath(double /*tau*/) {
  CheckInvariant(false, "the history of a model without a path is refused at the door");
  return {};
}

}  // namespace ricochet
