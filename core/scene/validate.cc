#include "core/scene/validate.h"

#include <string>
#include <utility>
#include <variant>

#include "absl/strings/str_cat.h"
#include "core/base/decimal.h"
#include "core/contact/reduction.h"
#include "core/scene/check.h"
#include "core/scene/numbers.h"

namespace ricochet {
namespace {

// Compares the static coefficient with the kinetic one, if each keeps its own rule.
void CheckStatic(const Friction& friction, Check& check) {
  const double kinetic = friction.kinetic_coefficient;
  const double value = friction.static_coefficient.value_or(kinetic);
  if (!Holds(kinetic, NumberRule::kNotNegative) || !Holds(value, NumberRule::kNotNegative)) return;
  check.Require(value >= kinetic, [&] {
    return MakeViolation("friction.static_coefficient", value,
                         absl::StrCat("be >= friction.kinetic_coefficient = ", ShortestDecimal(kinetic)),
                         {"friction.kinetic_coefficient"});
  });
}

void CheckSpeedDependence(const std::string& field, const SpeedDependence& dependence, Check& check) {
  check.RequireSet(!std::holds_alternative<std::monostate>(dependence), (field + ".form").c_str(),
                   "be one of power_law, table");
  const auto* table = std::get_if<SpeedTable>(&dependence);
  if (table == nullptr) return;
  const std::vector<double>& speeds = table->speed_m_s;
  check.Require(!speeds.empty(),
                [&] { return MakeViolation(field + ".table.speed_m_s", "has 0 entries", "have at least one"); });
  check.Length(field + ".table.factor", table->factor.size(), speeds.size());
  for (size_t i = 1; i < speeds.size(); ++i) {
    check.Require(speeds[i] > speeds[i - 1], [&] {
      const auto path = [&](size_t entry) { return absl::StrCat(field, ".table.speed_m_s[", entry, "]"); };
      return MakeViolation(path(i), speeds[i],
                           absl::StrCat("be > the speed before it, ", ShortestDecimal(speeds[i - 1])), {path(i - 1)});
    });
  }
}

void CheckRestitution(const Scene& scene, RestitutionIs restitution, Check& check) {
  const bool has_law = !std::holds_alternative<std::monostate>(scene.impact_law);
  const bool is_set = !std::holds_alternative<std::monostate>(scene.restitution);
  if (HasDamping(scene)) {
    check.Require(!is_set && !scene.restitution_by_speed.has_value(), [] {
      return MakeViolation("restitution", "is set beside compliance.hunt_crossley",
                           "not be, the damping stands for it");
    });
  } else if (has_law) {
    check.Require(!is_set && !scene.restitution_by_speed.has_value(), [] {
      return MakeViolation("restitution", "is set beside an impact law", "not be, the law states its own coefficient");
    });
  } else if (restitution == RestitutionIs::kRequired) {
    check.RequireSet(is_set, "restitution.coefficient", "be one of newton, poisson, energetic");
  }
}

const char* NameOf(std::monostate /*unset*/) { return ""; }
template <typename Law>
const char* NameOf(const Law& law) {
  return PrefixOf(law);
}

// Checks which other parts of a scene the system may be combined with.
void CheckTogether(const Scene& scene, Check& check) {
  if (std::holds_alternative<std::monostate>(scene.system)) return;
  const size_t directions = TangentialDirections(scene.system);
  if (scene.surface_velocity.has_value()) {
    check.Require(!std::holds_alternative<BodyPair>(scene.system), [] {
      return MakeViolation("surface_velocity", "is set", "not be for body_pair, whose body 2 is the surface");
    });
    const size_t entries = scene.surface_velocity->tangential_m_s.size();
    if (entries > 0) check.Length("surface_velocity.tangential_m_s", entries, directions);
  }
  check.Require(std::holds_alternative<std::monostate>(scene.impact_law) || directions == 1, [&] {
    const auto name = [](const auto& law) { return NameOf(law); };
    return MakeViolation(std::visit(name, scene.impact_law), "is set", "not be for a system in space");
  });
}

enum class Scope {
  kAll,
  kRelations,  // Only the rules that tie one number to another, for a scene that differs from a valid one in numbers.
};

// Checks the rules that do not depend on the contact.
void CheckFields(const Scene& scene, RestitutionIs restitution, Scope scope, Check& check) {
  CheckShape(scene.system, check);
  if (scope == Scope::kAll) {
    VisitNumbers(scene,
                 [&](const NumberPath& path, double value, NumberRule rule) { check.Number(path, value, rule); });
  }
  CheckStatic(scene.friction, check);
  if (scene.friction.by_speed.has_value()) CheckSpeedDependence("friction.by_speed", *scene.friction.by_speed, check);
  if (scope == Scope::kAll) CheckRestitution(scene, restitution, check);
  if (scene.restitution_by_speed.has_value())
    CheckSpeedDependence("restitution.by_speed", *scene.restitution_by_speed, check);
  if (scope == Scope::kAll) CheckTogether(scene, check);
  CheckEffects(scene, check);
}

void CheckScene(const Scene& scene, RestitutionIs restitution, Scope scope, Check& check,
                std::optional<SceneContact>& contact, const AnyReduction* known = nullptr) {
  contact.reset();
  CheckFields(scene, restitution, scope, check);
  if (!check.failed()) CheckContact(scene, known, check, contact);
}

// Compliance is for planar scenes alone.
bool IsCoupled(const Scene& scene) { return std::get<PlanarReduction>(Reduce(scene)).w[1] != 0.0; }

}  // namespace

std::vector<Violation> Validate(const Scene& scene, RestitutionIs restitution) {
  std::optional<SceneContact> contact;
  return Validate(scene, restitution, contact);
}

std::vector<Violation> Validate(const Scene& scene, RestitutionIs restitution, std::optional<SceneContact>& contact) {
  Check check(Check::Mode::kListing);
  CheckScene(scene, restitution, Scope::kAll, check, contact);
  return std::move(check).violations();
}

std::vector<Violation> Validate(const Scene& scene, RestitutionIs restitution, std::optional<SceneContact>& contact,
                                absl::FunctionRef<bool(const Violation&)> counts) {
  Check check(Check::Mode::kListing, counts);
  CheckScene(scene, restitution, Scope::kAll, check, contact);
  return std::move(check).violations();
}

bool HasRelations(const Scene& scene) {
  if (!std::holds_alternative<Pendulum>(scene.system)) return true;
  // A pendulum, kinetic friction and restitution have rules for single numbers only. Any other part may relate numbers.
  Scene plain;
  plain.system = scene.system;
  plain.friction.kinetic_coefficient = scene.friction.kinetic_coefficient;
  plain.restitution = scene.restitution;
  return scene != plain;
}

bool KeepsRelations(const Scene& scene, const AnyReduction* known, std::optional<SceneContact>& contact) {
  Check check(Check::Mode::kVerdict);
  CheckScene(scene, RestitutionIs::kRequired, Scope::kRelations, check, contact, known);
  return !check.failed();
}

void RequireRigid(const Scene& scene, RigidIn directions, const char* purpose, std::vector<Violation>& violations) {
  if (!scene.compliance.has_value()) return;
  const auto refuse = [&](const char* field) {
    violations.push_back(MakeViolation(field, "is set", absl::StrCat("not be, ", purpose, " of a rigid contact")));
  };
  const bool has_tangential = scene.compliance->tangential_ratio_squared.has_value();
  if (has_tangential && (directions == RigidIn::kBothDirections || IsCoupled(scene))) {
    refuse("compliance.tangential_ratio_squared");
  }
  const bool has_spring = !std::holds_alternative<std::monostate>(scene.compliance->normal);
  const bool has_forces = !std::holds_alternative<std::monostate>(scene.finite_forces);
  if (has_spring && has_forces) refuse("finite_forces");
}

}  // namespace ricochet
