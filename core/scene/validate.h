// Validate: checks every rule that a scene must keep, and lists all violations at once. All other code of the core
// relies on a valid scene. RequireRigid: what bounds and audits ask of a scene beside these rules.

#ifndef RICOCHET_CORE_SCENE_VALIDATE_H_
#define RICOCHET_CORE_SCENE_VALIDATE_H_

#include <optional>
#include <vector>

#include "absl/functional/function_ref.h"
#include "core/contact/scene_contact.h"
#include "ricochet/error.h"
#include "ricochet/scene.h"

namespace ricochet {

// Bounds hold for any restitution, so that a scene may leave it open there.
enum class RestitutionIs { kRequired, kOptional };

// Lists the violations of the rules in ricochet/scene.h, in field order, until the list is full (IsFull in
// ricochet/error.h); it is empty if the scene is valid. Paths start at the scene: "pendulum.a_m",
// "friction.kinetic_coefficient", "restitution.energetic".
std::vector<Violation> Validate(const Scene& scene, RestitutionIs restitution = RestitutionIs::kRequired);

// Does the same and keeps, for plan and model, the contact that the scene was reduced to. It stays empty where no rule
// takes reducing the scene: a pendulum's.
std::vector<Violation> Validate(const Scene& scene, RestitutionIs restitution, std::optional<SceneContact>& contact);

// Does the same and lists only violations of which `counts` is true.
std::vector<Violation> Validate(const Scene& scene, RestitutionIs restitution, std::optional<SceneContact>& contact,
                                absl::FunctionRef<bool(const Violation&)> counts);

// A fast check for sweeps. `scene` must differ from a valid scene in numbers only, and every number must keep its own
// rule (Holds in core/scene/numbers.h). Returns true if the rules between numbers hold as well.
// `known` is Reduce(scene) if the caller has it, else null. `contact` is as in Validate.
bool KeepsRelations(const Scene& scene, const AnyReduction* known, std::optional<SceneContact>& contact);

// False if KeepsRelations is true for all numbers that `scene` may have.
bool HasRelations(const Scene& scene);

// The directions in which a contact must be rigid.
enum class RigidIn { kNormal, kBothDirections };

// Names what makes a contact other than the rigid one without forces that audits and bounds know. A spring along the
// normal alone changes no velocity after the impact, and one along the tangent none of the normal velocities where
// Wtn = 0. All other rules of the scene must hold. `purpose` begins the reason: "for an audit".
void RequireRigid(const Scene& scene, RigidIn directions, const char* purpose, std::vector<Violation>& violations);

}  // namespace ricochet

#endif  // RICOCHET_CORE_SCENE_VALIDATE_H_
