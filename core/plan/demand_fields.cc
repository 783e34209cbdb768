#include "core/plan/demand_fields.h"

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <utility>

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

void CheckLists(const DemandFields& fields, std::vector<Violation>& violations) {
  CheckList(fields.required, "required", violations);
  CheckList(fields.excluded, "excluded", violations);
}

// A set counts its effects in order of their numbers; the violation shall count those of the list.
void NameByList(const std::vector<Effect>& list, const char* field, Violation& violation) {
  std::vector<Effect> in_order = list;
  std::sort(in_order.begin(), in_order.end());
  for (size_t i = 0; i < in_order.size(); ++i) {
    if (violation.field != absl::StrCat(field, "[", i, "]")) continue;
    const auto place = std::find(list.begin(), list.end(), in_order[i]) - list.begin();
    violation.field = absl::StrCat(field, "[", place, "]");
    return;
  }
}

}  // namespace

Demand ToDemand(const DemandFields& fields) {
  Demand demand = {.required = ToSet(fields.required), .excluded = ToSet(fields.excluded)};
  if (fields.relative_tolerance.has_value()) demand.relative_tolerance = *fields.relative_tolerance;
  return demand;
}

std::vector<Violation> CheckDemand(const DemandFields& fields) {
  std::vector<Violation> violations;
  if (fields.relative_tolerance.has_value()) CheckTolerance(*fields.relative_tolerance, violations);
  CheckLists(fields, violations);
  return violations;
}

std::vector<Violation> CheckDemand(const Scene& scene, std::optional<SceneContact>& contact,
                                   const DemandFields& fields) {
  std::vector<Violation> violations;
  CheckLists(fields, violations);
  if (!violations.empty()) return violations;
  violations = CheckDemand(scene, contact, ToDemand(fields));
  for (Violation& violation : violations) {
    for (const auto& [list, field] : {std::pair(&fields.required, "required"), std::pair(&fields.excluded, "excluded")})
      NameByList(*list, field, violation);
  }
  return violations;
}

}  // namespace ricochet
