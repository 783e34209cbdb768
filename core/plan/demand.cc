#include "core/plan/demand.h"

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <utility>
#include <variant>

#include "absl/strings/str_cat.h"
#include "core/plan/planned_scene.h"
#include "core/plan/scene_problem.h"
#include "core/scene/check.h"

namespace ricochet {
namespace {

constexpr double kLargestTolerance = 0.1;

bool HasFriction(const Scene& scene) {
  return std::max(scene.friction.kinetic_coefficient,
                  scene.friction.static_coefficient.value_or(scene.friction.kinetic_coefficient)) > 0.0;
}

bool IsInSpace(const Scene& scene) { return TangentialDirections(scene.system) == 2; }

// True if the scene has finite forces and a spring, so that the forces have time to act.
bool HasFiniteForces(const Scene& scene) { return MissingPart(scene, Effect::kFiniteForces).empty(); }

// The reason why the effect cannot be left out; empty if it can, or if that depends on the numbers of the contact.
std::string WhyNotExcluded(const Scene& scene, Effect effect, EffectSet excluded, EffectSet required) {
  const bool rubs = !excluded.Has(Effect::kFriction);
  const bool takes_time = HasDamping(scene) || required.Has(Effect::kFiniteDuration) ||
                          (HasFiniteForces(scene) && !excluded.Has(Effect::kFiniteForces));
  switch (effect) {
    case Effect::kUnspecified:
      return "be an effect that is named";
    case Effect::kSlipStop:
    case Effect::kSlipTurn:
      if (effect == Effect::kSlipTurn && !IsInSpace(scene)) return "be left in: in a plane slip cannot turn";
      if (!rubs) return "";
      if (HasClosedForm(scene)) return "be left in: a pendulum's slip stops where compression ends; exclude friction";
      return takes_time ? "be left in: the model of finite duration has slip that stops; exclude friction" : "";
    case Effect::kFiniteDuration:
      return HasDamping(scene) ? "be left in: the spring's damping is the restitution" : "";
    case Effect::kHigherOrder:
      if (!HasClosedForm(scene)) return "be left in: only a pendulum over a surface at rest has a first-order form";
      if (!rubs) return "";
      return takes_time ? "be left in: the first-order form has no duration; exclude finite_forces" : "";
    case Effect::kFriction:
    case Effect::kStaticFriction:
    case Effect::kTangentialCompliance:
    case Effect::kFiniteForces:
      break;
  }
  return "";
}

template <typename Visit>
void ForEach(EffectSet effects, const char* field, const Visit& visit) {
  int i = 0;
  for (const Effect effect : kEffects) {
    if (effects.Has(effect)) visit(effect, absl::StrCat(field, "[", i++, "]"));
  }
}

Violation Refuse(std::string path, Effect effect, std::string rule) {
  return MakeViolation(std::move(path), absl::StrCat("= ", NameOf(effect)), std::move(rule));
}

// Returns the excluded effect because of which `effect` is left out.
Effect CauseOf(Effect effect, EffectSet excluded, bool in_space) {
  for (const Effect cause : kEffects) {
    if (excluded.Has(cause) && WithImplied({cause}, in_space).Has(effect)) return cause;
  }
  return effect;
}

void CheckRequired(const Scene& scene, const Demand& demand, std::vector<Violation>& violations) {
  const bool in_space = IsInSpace(scene);
  const EffectSet excluded = WithImplied(demand.excluded, in_space);
  ForEach(demand.required, "required", [&](Effect effect, std::string path) {
    const std::string lacking = MissingPart(scene, effect);
    if (!lacking.empty()) {
      violations.push_back(Refuse(std::move(path), effect, "not be required of a scene without " + lacking));
    } else if (excluded.Has(effect)) {
      const Effect cause = demand.excluded.Has(effect) ? effect : CauseOf(effect, demand.excluded, in_space);
      const std::string rule = cause == effect ? "not be excluded too"
                                               : absl::StrCat("not be required where ", NameOf(cause), " is excluded");
      violations.push_back(Refuse(std::move(path), effect, rule));
    }
  });
}

bool CheckExcluded(const Scene& scene, const Demand& demand, std::vector<Violation>& violations) {
  const EffectSet excluded = WithImplied(demand.excluded, IsInSpace(scene));
  const size_t before = violations.size();
  ForEach(demand.excluded, "excluded", [&](Effect effect, std::string path) {
    const std::string reason = WhyNotExcluded(scene, effect, excluded, demand.required);
    if (!reason.empty()) violations.push_back(Refuse(std::move(path), effect, reason));
  });
  return violations.size() == before;
}

void CheckTolerance(double relative_tolerance, std::vector<Violation>& violations) {
  if (relative_tolerance >= 0.0 && relative_tolerance <= kLargestTolerance) return;
  violations.push_back(
      MakeViolation("relative_tolerance", relative_tolerance, absl::StrCat("be in [0, ", kLargestTolerance, "]")));
}

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

std::string MissingPart(const Scene& scene, Effect effect) {
  const auto unless = [](bool holds, const char* lacking) { return std::string(holds ? "" : lacking); };
  const bool rubs = HasFriction(scene);
  switch (effect) {
    case Effect::kUnspecified:
      return "an effect that is named";
    case Effect::kFriction:
    case Effect::kSlipStop:
      return unless(rubs, "friction.kinetic_coefficient > 0");
    case Effect::kSlipTurn:
      return !IsInSpace(scene) ? "a system in space" : unless(rubs, "friction.kinetic_coefficient > 0");
    case Effect::kStaticFriction:
      return unless(scene.friction.static_coefficient.value_or(0.0) > scene.friction.kinetic_coefficient,
                    "friction.static_coefficient > friction.kinetic_coefficient");
    case Effect::kTangentialCompliance:
      return unless(scene.compliance.has_value() && scene.compliance->tangential_ratio_squared.has_value(),
                    "compliance.tangential_ratio_squared");
    case Effect::kFiniteForces:
      if (std::holds_alternative<std::monostate>(scene.finite_forces)) return "finite forces";
      [[fallthrough]];
    case Effect::kFiniteDuration:
      return unless(scene.compliance.has_value() && !std::holds_alternative<std::monostate>(scene.compliance->normal),
                    "a normal spring in compliance");
    case Effect::kHigherOrder:
      return unless(HasClosedForm(scene), "a pendulum over a surface at rest");
  }
  return "";
}

EffectSet WithImplied(EffectSet excluded, bool in_space) {
  EffectSet all = excluded;
  if (all.Has(Effect::kFriction)) all = all | kOnFriction;
  if (in_space && (all.Has(Effect::kSlipStop) || all.Has(Effect::kSlipTurn))) {
    all = all | EffectSet{Effect::kSlipStop, Effect::kSlipTurn};
  }
  if (all.Has(Effect::kSlipStop)) all = all | EffectSet{Effect::kStaticFriction, Effect::kTangentialCompliance};
  if (all.Has(Effect::kFiniteDuration)) all.Add(Effect::kFiniteForces);
  return all;
}

std::vector<Violation> CheckDemand(const Scene& scene, std::optional<SceneContact>& contact, const Demand& demand) {
  std::vector<Violation> violations;
  CheckTolerance(demand.relative_tolerance, violations);
  if (!std::holds_alternative<std::monostate>(scene.impact_law)) {
    const auto refuse = [&](Effect effect, std::string path) {
      violations.push_back(Refuse(std::move(path), effect, "not be here: an impact law states its own effects"));
    };
    ForEach(demand.required, "required", refuse);
    ForEach(demand.excluded, "excluded", refuse);
    return violations;
  }
  if (demand.IsToleranceAlone()) return violations;
  CheckRequired(scene, demand, violations);
  if (CheckExcluded(scene, demand, violations) && violations.empty()) {
    return CheckSolvableWithout(scene, contact, demand);
  }
  return violations;
}

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

std::vector<Violation> CheckSolvableWithout(const Scene& scene, std::optional<SceneContact>& contact,
                                            const Demand& demand) {
  std::vector<Violation> violations;
  const EffectSet limited = {Effect::kSlipStop, Effect::kSlipTurn, Effect::kHigherOrder};
  const EffectSet asked = demand.excluded & limited;
  if (asked.IsEmpty() || demand.excluded.Has(Effect::kFriction)) return violations;
  if (!HasClosedForm(scene)) {
    if (!contact.has_value()) contact.emplace(scene);
    if (!FitsDoubles(contact->reduction)) return violations;
  }
  if (PlanScene(scene, contact, demand).choice.model != Model::kUnspecified) return violations;
  const char* higher_order =
      "be left in: the first-order form needs mu |b|/a <= 0.5, no lock, and a coefficient within its own bound";
  const char* slip =
      "be left in: slip in a straight line needs u0 != 0, mu |Wtn| < Wnn, a W of full rank and a coefficient of "
      "restitution <= 1";
  ForEach(demand.excluded, "excluded", [&](Effect effect, std::string path) {
    if (!asked.Has(effect)) return;
    violations.push_back(Refuse(std::move(path), effect, effect == Effect::kHigherOrder ? higher_order : slip));
  });
  return violations;
}

const char* NameOf(Effect effect) {
  static constexpr const char* kNames[] = {"unspecified",     "friction",        "slip_stop",
                                           "slip_turn",       "static_friction", "tangential_compliance",
                                           "finite_duration", "finite_forces",   "higher_order"};
  static_assert(std::size(kNames) == kEffectCount);
  const auto number = static_cast<size_t>(effect);
  return number < std::size(kNames) ? kNames[number] : kNames[0];
}

}  // namespace ricochet
