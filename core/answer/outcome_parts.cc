#include "core/answer/outcome_parts.h"

#include <cmath>
#include <optional>
#include <string_view>
#include <variant>

#include "absl/strings/str_cat.h"
#include "core/numerics/decimal.h"
#include "ricochet/outcome_numbers.h"

namespace ricochet {
namespace {

bool AllFinite(const std::vector<double>& values) {
  for (const double value : values) {
    if (!std::isfinite(value)) return false;
  }
  return true;
}

absl::Status CheckFinite(const State& state, const std::string& path) {
  if (!std::isfinite(state.contact_velocity.normal_m_s)) return OutputOverflow(path + "contact_velocity.normal_m_s");
  const std::vector<double>& tangential = state.contact_velocity.tangential_m_s;
  for (size_t i = 0; i < tangential.size(); ++i) {
    if (std::isfinite(tangential[i])) continue;
    return OutputOverflow(absl::StrCat(path, "contact_velocity.tangential_m_s[", i, "]"));
  }
  if (!std::isfinite(state.normal_impulse_n_s)) return OutputOverflow(path + "normal_impulse_n_s");
  if (!AllFinite(state.tangential_impulse_n_s)) return OutputOverflow(path + "tangential_impulse_n_s");
  return AllFinite(state.rates_rad_s) ? absl::OkStatus() : OutputOverflow(path + "rates_rad_s");
}

}  // namespace

std::vector<BrokenLimit> BrokenLimits(const LimitFindings& findings) {
  std::vector<BrokenLimit> broken;
  if (findings.sharp_broken) {
    broken.push_back(
        {.kind = LimitKind::kSharp, .value = findings.energetic, .limit = 1.0, .excess = findings.energetic_excess});
  }
  if (findings.energy_broken) {
    broken.push_back(
        {.kind = LimitKind::kEnergy, .value = findings.energy_change, .limit = 0.0, .excess = findings.energy_change});
  }
  return broken;
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

std::vector<Violation> CheckHistory(absl::Span<const double> taus, double tau1) {
  std::vector<Violation> violations;
  if (taus.size() > kMaxHistory) {
    violations.push_back(
        {"history_at_n_s", absl::StrCat("has ", taus.size(), " entries: must have at most ", kMaxHistory)});
    return violations;
  }
  for (size_t i = 0; i < taus.size(); ++i) {
    if (taus[i] >= 0.0 && taus[i] <= tau1) continue;
    violations.push_back(MakeViolation(absl::StrCat("history_at_n_s[", i, "]"), taus[i],
                                       absl::StrCat("be in [0, tau1 = ", ShortestDecimal(tau1), "]")));
  }
  return violations;
}

std::vector<Violation> RefuseHistory(absl::Span<const double> taus, const std::string& whom) {
  if (taus.empty()) return {};
  return {{"history_at_n_s",
           absl::StrCat("has ", taus.size(), taus.size() == 1 ? " entry" : " entries", ": must be empty for ", whom)}};
}

absl::Status CheckFinite(const Outcome& outcome) {
  std::optional<NumberPath> wrong;
  VisitOutcomeNumbers(outcome, [&wrong](const NumberPath& path, double number) {
    const bool may_be_infinite = std::string_view(path.name) == "relative_error";
    if (!wrong.has_value() && !may_be_infinite && !std::isfinite(number)) wrong = path;
  });
  if (wrong.has_value()) return OutputOverflow("outcome." + wrong->Text());
  for (size_t i = 0; i < outcome.timeline.size(); ++i) {
    absl::Status status = CheckFinite(outcome.timeline[i].state, absl::StrCat("outcome.timeline[", i, "].state."));
    if (!status.ok()) return status;
  }
  return absl::OkStatus();
}

}  // namespace ricochet
