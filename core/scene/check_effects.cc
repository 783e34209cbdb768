#include <variant>

#include "core/scene/check.h"
#include "core/scene/numbers.h"

namespace ricochet {
namespace {

bool GoesWith(const PinMoment& /*moment*/, const System& system) { return std::holds_alternative<Pendulum>(system); }
bool GoesWith(const ContactAcceleration& /*acceleration*/, const System& system) {
  return std::holds_alternative<PlanarContact>(system);
}
bool GoesWith(const Gravity& /*gravity*/, const System& system) {
  if (const auto* pair = std::get_if<BodyPair>(&system)) return std::holds_alternative<PlanarPair>(pair->bodies);
  return std::holds_alternative<PlanarBody>(system) || std::holds_alternative<Linkage>(system);
}

// The rule that says which systems may have the forces.
const char* RuleOf(const PinMoment& /*moment*/) { return "only be for pendulum"; }
const char* RuleOf(const ContactAcceleration& /*acceleration*/) { return "only be for planar_contact"; }
const char* RuleOf(const Gravity& /*gravity*/) { return "only be for planar_body, body_pair.planar and linkage"; }

void CheckForces(std::monostate /*none*/, const System& /*system*/, bool /*has_law*/, Check& /*check*/) {}

template <typename Forces>
void CheckForces(const Forces& forces, const System& system, bool has_law, Check& check) {
  check.Require(GoesWith(forces, system) || std::holds_alternative<std::monostate>(system),
                [&] { return MakeViolation(PrefixOf(forces), "is set", RuleOf(forces)); });
  check.Require(!has_law, [&] {
    return MakeViolation(PrefixOf(forces), "is set beside an impact law", "not be, an impact law has no duration");
  });
}

void CheckTangential(const Scene& scene, const Compliance& compliance, Check& check) {
  const bool linear_or_none = std::holds_alternative<std::monostate>(compliance.normal) ||
                              std::holds_alternative<LinearSpring>(compliance.normal);
  check.Require(linear_or_none, [] {
    return MakeViolation("compliance.tangential_ratio_squared", "is set beside hertz or hunt_crossley",
                         "not be, the ratio is one of constant stiffnesses");
  });
  const double kinetic = scene.friction.kinetic_coefficient;
  check.Require(scene.friction.static_coefficient.value_or(kinetic) == kinetic, [] {
    return MakeViolation("friction.static_coefficient", "is set beside compliance.tangential_ratio_squared",
                         "be friction.kinetic_coefficient or unset", ViolationKind::kValue,
                         {"friction.kinetic_coefficient"});
  });
}

}  // namespace

bool HasDamping(const Scene& scene) {
  return scene.compliance.has_value() && std::holds_alternative<HuntCrossleySpring>(scene.compliance->normal);
}

void CheckEffects(const Scene& scene, Check& check) {
  const bool has_law = !std::holds_alternative<std::monostate>(scene.impact_law);
  std::visit([&](const auto& forces) { CheckForces(forces, scene.system, has_law, check); }, scene.finite_forces);
  if (!scene.compliance.has_value()) return;
  const Compliance& compliance = *scene.compliance;
  check.Require(!has_law, [] {
    return MakeViolation("compliance", "is set beside an impact law", "not be, an impact law has no springs");
  });
  check.Require(std::holds_alternative<std::monostate>(scene.system) || TangentialDirections(scene.system) == 1,
                [] { return MakeViolation("compliance", "is set", "not be for a system in space"); });
  const bool has_spring = !std::holds_alternative<std::monostate>(compliance.normal);
  check.Require(has_spring || compliance.tangential_ratio_squared.has_value(), [] {
    return MakeViolation("compliance", "is empty",
                         "state tangential_ratio_squared or one of linear, hertz, "
                         "hunt_crossley");
  });
  if (compliance.tangential_ratio_squared.has_value()) CheckTangential(scene, compliance, check);
}

}  // namespace ricochet
