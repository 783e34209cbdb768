#include "core/models/pendulum_outcome.h"

#include <cmath>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "core/error.h"
#include "core/numerics/decimal.h"

namespace ricochet::pendulum {
namespace {

// The state of the contact at angular velocity `omega`; one rounding a product.
State MakeState(const Problem& problem, double tau, double omega, double tangential_impulse) {
  return {.normal_impulse_n_s = tau,
          .tangential_impulse_n_s = {tangential_impulse},
          .contact_velocity = {.tangential_m_s = {problem.b * omega + 0.0}, .normal_m_s = problem.a * omega},
          .rates_rad_s = {omega}};
}

std::vector<Event> MakeTimeline(const Problem& problem, const Impact& impact) {
  const State start = MakeState(problem, 0.0, problem.omega_minus, 0.0);
  const State rest =
      MakeState(problem, impact[Output::kNormalImpulseCompression], 0.0, impact[Output::kTangentialImpulseCompression]);
  std::vector<Event> timeline = {{EventKind::kStart, start}};
  if (problem.b != 0.0) timeline.push_back({EventKind::kSlipStops, rest});
  timeline.push_back({EventKind::kCompressionEnds, rest});
  if (impact.regime != Regime::kLocked) {
    timeline.push_back(
        {EventKind::kRestitutionEnds, MakeState(problem, impact[Output::kNormalImpulse], impact[Output::kOmegaPlus],
                                                impact[Output::kTangentialImpulse])});
  }
  return timeline;
}

std::vector<BrokenLimit> BrokenLimits(const Impact& impact) {
  std::vector<BrokenLimit> broken;
  if (impact.sharp_limit_broken) {
    broken.push_back({.kind = LimitKind::kSharp,
                      .value = impact[Output::kEnergetic],
                      .limit = 1.0,
                      .excess = impact[Output::kEnergeticExcess]});
  }
  if (impact.energy_limit_broken) {
    broken.push_back({.kind = LimitKind::kEnergy,
                      .value = impact[Output::kEnergyChange],
                      .limit = 0.0,
                      .excess = impact[Output::kEnergyChange]});
  }
  return broken;
}

WorkLedger MakeLedger(const Impact& impact) {
  WorkLedger work = {.normal_compression_j = impact[Output::kWorkNormalCompression],
                     .normal_restitution_j = impact[Output::kWorkNormalRestitution],
                     .tangential_compression_j = impact[Output::kWorkTangentialCompression],
                     .tangential_restitution_j = impact[Output::kWorkTangentialRestitution],
                     .normal_total_j = impact[Output::kWorkNormal],
                     .tangential_total_j = impact[Output::kWorkTangential]};
  work.residual_j = work.normal_compression_j + work.normal_restitution_j + work.tangential_compression_j +
                    work.tangential_restitution_j - impact[Output::kEnergyChange];
  return work;
}

absl::Status CheckFinite(const Impact& impact, const std::vector<Event>& timeline) {
  for (int i = 0; i < kOutputCount; ++i) {
    const auto output = static_cast<Output>(i);
    const std::string path = OutputPath(output);
    if (!path.empty() && !std::isfinite(impact[output])) return OutputOverflow("outcome." + path);
  }
  for (size_t i = 0; i < timeline.size(); ++i) {
    const ContactVelocity& velocity = timeline[i].state.contact_velocity;
    const std::string path = absl::StrCat("outcome.timeline[", i, "].state.contact_velocity.");
    if (!std::isfinite(velocity.normal_m_s)) return OutputOverflow(path + "normal_m_s");
    if (!std::isfinite(velocity.tangential_m_s[0])) return OutputOverflow(path + "tangential_m_s[0]");
  }
  return absl::OkStatus();
}

std::vector<Violation> CheckHistory(absl::Span<const double> taus, double tau1) {
  std::vector<Violation> violations;
  if (taus.size() > kMaxHistory) {
    violations.push_back(
        {"history_at_n_s", absl::StrCat("has ", taus.size(), " entries: must have ", "at most ", kMaxHistory)});
    return violations;
  }
  for (size_t i = 0; i < taus.size(); ++i) {
    if (taus[i] >= 0.0 && taus[i] <= tau1) continue;
    violations.push_back(MakeViolation(absl::StrCat("history_at_n_s[", i, "]"), taus[i],
                                       absl::StrCat("be in [0, tau1 = ", ShortestDecimal(tau1), "]")));
  }
  return violations;
}

State StateAt(const Problem& problem, double tau) {
  if (problem.omega_minus >= 0.0) return MakeState(problem, tau, problem.omega_minus, 0.0);
  const Instant instant = At(problem, tau);
  return MakeState(problem, tau, instant.omega, instant.tangential_impulse);
}

}  // namespace

std::string OutputPath(Output output) {
  switch (output) {
    case Output::kNewton:
      return "coefficients.newton";
    case Output::kPoisson:
      return "coefficients.poisson";
    case Output::kEnergetic:
      return "coefficients.energetic";
    case Output::kTangentialCoefficient:
      return "coefficients.tangential";
    case Output::kOmegaPlus:
      return "rates_after_rad_s[0]";
    case Output::kTangentialVelocityAfter:
      return "contact_velocity_after.tangential_m_s[0]";
    case Output::kNormalVelocityAfter:
      return "contact_velocity_after.normal_m_s";
    case Output::kNormalImpulseCompression:
      return "impulse.normal_compression_n_s";
    case Output::kNormalImpulse:
      return "impulse.normal_total_n_s";
    case Output::kTangentialImpulse:
      return "impulse.tangential_n_s[0]";
    case Output::kWorkNormalCompression:
      return "work.normal_compression_j";
    case Output::kWorkNormalRestitution:
      return "work.normal_restitution_j";
    case Output::kWorkTangentialCompression:
      return "work.tangential_compression_j";
    case Output::kWorkTangentialRestitution:
      return "work.tangential_restitution_j";
    case Output::kWorkNormal:
      return "work.normal_total_j";
    case Output::kWorkTangential:
      return "work.tangential_total_j";
    case Output::kEnergyChange:
      return "energy_change_j";
    case Output::kTangentialImpulseCompression:
    case Output::kEnergeticExcess:
      return "";
  }
  return "";
}

absl::StatusOr<Outcome> MakeOutcome(const Problem& problem, absl::Span<const double> history_at_n_s) {
  const Impact impact = Solve(problem);
  const bool separating = impact.regime == Regime::kSeparating;
  std::vector<Event> timeline;
  if (!separating) timeline = MakeTimeline(problem, impact);
  const absl::Status finite = CheckFinite(impact, timeline);
  if (!finite.ok()) return finite;
  const auto violations = CheckHistory(history_at_n_s, impact[Output::kNormalImpulse]);
  if (!violations.empty()) return InvalidRequest(violations);

  Outcome outcome;
  outcome.regime = impact.regime;
  outcome.broken_limits = BrokenLimits(impact);
  outcome.admissible = outcome.broken_limits.empty();
  outcome.w_rank = 1;
  outcome.coefficients = {.newton = impact[Output::kNewton],
                          .poisson = impact[Output::kPoisson],
                          .energetic = impact[Output::kEnergetic],
                          .tangential = impact[Output::kTangentialCoefficient]};
  outcome.rates_after_rad_s = {impact[Output::kOmegaPlus]};
  outcome.contact_velocity_after = {.tangential_m_s = {impact[Output::kTangentialVelocityAfter]},
                                    .normal_m_s = impact[Output::kNormalVelocityAfter]};
  outcome.impulse = {.normal_compression_n_s = impact[Output::kNormalImpulseCompression],
                     .normal_total_n_s = impact[Output::kNormalImpulse],
                     .tangential_n_s = {impact[Output::kTangentialImpulse]}};
  outcome.work = MakeLedger(impact);
  outcome.energy_change_j = impact[Output::kEnergyChange];
  outcome.timeline = std::move(timeline);
  for (const double tau : history_at_n_s) outcome.history.push_back(StateAt(problem, tau));
  return outcome;
}

}  // namespace ricochet::pendulum
