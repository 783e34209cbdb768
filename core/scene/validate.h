// Validate: the door. Every rule that a scene must keep, all violations at once.

#ifndef RICOCHET_CORE_SCENE_VALIDATE_H_
#define RICOCHET_CORE_SCENE_VALIDATE_H_

#include <vector>

#include "ricochet/error.h"
#include "ricochet/scene.h"

namespace ricochet {

// Whether a scene may leave its restitution open: bounds do not need it.
enum class RestitutionIs { kRequired, kOptional };

// Every violation of the rules in ricochet/scene.h, in field order; empty if the scene is valid. Paths start at the
// scene: "pendulum.a_m", "friction.kinetic_coefficient", "restitution.energetic".
std::vector<Violation> Validate(const Scene& scene, RestitutionIs restitution = RestitutionIs::kRequired);

// Whether Validate(scene) finds nothing, without the cost of saying what, in a scene that differs only by numbers from
// one in which it found nothing, if each of them keeps its own rule: Holds in core/scene/numbers.h.
bool KeepsRelations(const Scene& scene);

// Whether that can be false at all, whatever the numbers are.
bool HasRelations(const Scene& scene);

}  // namespace ricochet

#endif  // RICOCHET_CORE_SCENE_VALIDATE_H_
