#include "core/plan/number_demand.h"

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "ricochet/error.h"

namespace ricochet {
namespace {

// Says which effect a number needs, and which rule of the request stands against it.
std::string Against(Effect effect, const Violation& violation) {
  const std::string needs = absl::StrCat("needs ", NameOf(effect), ", ");
  if (!absl::StartsWith(violation.field, "required")) {
    return absl::StrCat(needs, "and ", violation.field, " ", violation.description);
  }
  return absl::StrCat(needs, "which must ", violation.rule);
}

}  // namespace

std::optional<Effect> EffectBehind(absl::string_view path) {
  if (absl::StartsWith(path, "contact.")) return Effect::kFiniteDuration;
  return std::nullopt;
}

Demand WithNumbers(Demand demand, absl::Span<const std::string> paths) {
  for (const std::string& path : paths) {
    if (const auto effect = EffectBehind(path)) demand.required.Add(*effect);
  }
  return demand;
}

std::string LackingForNumber(const Scene& scene, absl::string_view path) {
  const std::optional<Effect> effect = EffectBehind(path);
  return effect.has_value() ? MissingPart(scene, *effect) : "";
}

std::vector<std::string> WhyNoNumber(const Scene& scene, std::optional<SceneContact>& contact, const Demand& demand,
                                     absl::string_view path) {
  const std::optional<Effect> effect = EffectBehind(path);
  if (!effect.has_value() || demand.required.Has(*effect)) return {};
  const std::string lacking = MissingPart(scene, *effect);
  if (!lacking.empty()) return {absl::StrCat("must not be asked of a scene without ", lacking)};
  Demand asked = demand;
  asked.required.Add(*effect);
  std::vector<std::string> reasons;
  for (const Violation& violation : CheckDemand(scene, contact, asked)) reasons.push_back(Against(*effect, violation));
  return reasons;
}

}  // namespace ricochet
