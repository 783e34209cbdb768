#include "core/answer/derivative_sides.h"

#include <variant>

#include "absl/strings/str_cat.h"
#include "core/scene/system_velocities.h"

namespace ricochet {

Derivative Join(const OneSided& below, const OneSided& above, bool agree, Threshold threshold) {
  Derivative derivative = {.from_below = below.rate, .from_above = above.rate};
  if (agree) {
    derivative.kind = DerivativeKind::kTwoSided;
    derivative.value = derivative.from_below = derivative.from_above;
    return derivative;
  }
  const bool has_side = below.rate.has_value() || above.rate.has_value();
  derivative.kind = has_side ? DerivativeKind::kOneSided : DerivativeKind::kNone;
  derivative.threshold = threshold;
  if (!below.rate.has_value()) absl::StrAppend(&derivative.reason, "Below, ", below.why_none, ".");
  if (!above.rate.has_value()) {
    absl::StrAppend(&derivative.reason, derivative.reason.empty() ? "" : " ", "Above, ", above.why_none, ".");
  }
  return derivative;
}

double ScaleOf(std::string_view path, double speed, double impulse) {
  if (path.starts_with("coefficients.")) return 1.0;
  if (path.starts_with("impulse.")) return impulse;
  if (path.starts_with("contact_velocity_after.")) return speed;
  if (path.starts_with("work.") || path == "energy_change_j") return impulse * speed;
  return 0.0;
}

std::vector<std::string> LinearNumberPaths(const System& system) {
  std::vector<std::string> paths = SystemVelocityPaths(system);
  const auto* const mechanism = std::get_if<Mechanism>(&system);
  const size_t coordinates = mechanism == nullptr ? 0 : mechanism->rates.size();
  for (size_t i = 0; i < coordinates; ++i) paths.push_back(absl::StrCat("momentum_change[", i, "]"));
  return paths;
}

}  // namespace ricochet
