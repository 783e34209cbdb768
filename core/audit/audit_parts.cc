#include "core/audit/audit_parts.h"

#include <utility>
#include <variant>

#include "core/contact/coefficients_at_speed.h"
#include "core/plan/scene_problem.h"
#include "core/scene/rigid.h"
#include "core/scene/validate.h"

namespace ricochet::audit {

std::vector<Violation> CheckScene(const Scene& scene, std::optional<SceneContact>& contact) {
  std::vector<Violation> violations = Validate(scene, RestitutionIs::kOptional, contact);
  if (violations.empty()) RequireRigid(scene, RigidIn::kNormal, "for an audit", violations);
  if (!violations.empty()) return violations;
  if (!contact.has_value()) contact.emplace(scene);
  if (std::visit([](const auto& reduction) { return reduction.w.back() == 0.0; }, contact->reduction)) {
    violations.push_back(MakeViolation("system", "makes Wnn = 0",
                                       "be > 0 for an audit, no normal impulse moves the contact",
                                       ViolationKind::kContact));
    return violations;
  }
  const bool is_covered = std::visit(
      [](const auto& reduction) { return reduction.v0 >= 0.0 || VelocityIsInRange(reduction); }, contact->reduction);
  if (!is_covered) {
    violations.push_back(MakeViolation(scene.surface_velocity.has_value() ? "surface_velocity" : "system",
                                       "makes a contact velocity beside the range of W, whose rank is not full",
                                       "lie in it for an "
                                       "audit, which knows no impact of this kind",
                                       ViolationKind::kContact));
  }
  return violations;
}

Scene WithoutRestitution(Scene scene) {
  scene.restitution = std::monostate();
  scene.restitution_by_speed.reset();
  scene.impact_law = std::monostate();
  return scene;
}

AnyProblem MakeProblem(const Scene& scene, const SceneContact& contact, bool from_own_velocity) {
  if (from_own_velocity && HasClosedForm(scene)) return ClosedFormProblem(scene);
  const AnyReduction& any = contact.reduction;
  EffectiveCoefficients effective = contact.coefficients;
  effective.restitution = 0.0;  // The path up to an observed impulse does not depend on it.
  if (const auto* planar = std::get_if<PlanarReduction>(&any)) {
    return planar::MakeProblem(*planar, EnergeticCoefficient(), effective);
  }
  return spatial::MakeProblem(std::get<SpatialReduction>(any), EnergeticCoefficient(), effective,
                              spatial::kStudyTolerance);
}

}  // namespace ricochet::audit
