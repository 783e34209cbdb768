// RequireRigid: names what makes a contact other than the rigid one without forces that audits and bounds know.

#ifndef RICOCHET_CORE_SCENE_RIGID_H_
#define RICOCHET_CORE_SCENE_RIGID_H_

#include <vector>

#include "ricochet/error.h"
#include "ricochet/scene.h"

namespace ricochet {

// The directions in which a contact must be rigid.
enum class RigidIn { kNormal, kBothDirections };

// A spring along the normal alone changes no velocity after the impact, and one along the tangent none of the normal
// velocities where Wtn = 0. All other rules of the scene must hold. `purpose` begins the reason: "for an audit".
void RequireRigid(const Scene& scene, RigidIn directions, const char* purpose, std::vector<Violation>& violations);

}  // namespace ricochet

#endif  // RICOCHET_CORE_SCENE_RIGID_H_
