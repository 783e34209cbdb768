#include "core/plan/demand_fields.h"

#include <algorithm>
#include <cstdint>
#include <iterator>

#include "absl/strings/str_cat.h"

namespace ricochet {
namespace {

EffectSet ToSet(const std::vector<Effect>& effects) {
  EffectSet set;
  for (const Effect effect : effects) set.Add(effect);
  return set;
}

std::string NotNamed(int64_t number) { return number == 0 ? "= unspecified" : absl::StrCat("= ", number); }

// Checks the list for an effect that is not named or that is named twice, because a set could not show either.
void CheckList(const std::vector<Effect>& effects, const char* field, std::vector<Violation>& violations) {
  EffectSet seen;
  for (size_t i = 0; i < effects.size() && !IsFull(violations); ++i) {
    const auto path = [&] { return absl::StrCat(field, "[", i, "]"); };
    if (std::find(std::begin(kEffects), std::end(kEffects), effects[i]) == std::end(kEffects)) {
      violations.push_back(
          MakeViolation(path(), NotNamed(static_cast<int64_t>(effects[i])), "be an effect that is named"));
      continue;
    }
    if (seen.Has(effects[i])) {
      violations.push_back(MakeViolation(path(), absl::StrCat("= ", NameOf(effects[i])), "be named once"));
    }
    seen.Add(effects[i]);
  }
}

}  // namespace

Demand ToDemand(const DemandFields& fields) {
  Demand demand = {.required = ToSet(fields.required), .excluded = ToSet(fields.excluded)};
  if (fields.relative_tolerance.has_value()) demand.relative_tolerance = *fields.relative_tolerance;
  return demand;
}

std::vector<Violation> CheckDemand(const Scene& scene, std::optional<SceneContact>& contact,
                                   const DemandFields& fields) {
  if (!fields.required.empty() || !fields.excluded.empty()) {
    std::vector<Violation> violations;
    CheckList(fields.required, "required", violations);
    CheckList(fields.excluded, "excluded", violations);
    if (!violations.empty()) return violations;
  }
  return CheckDemand(scene, contact, ToDemand(fields));
}

}  // namespace ricochet
