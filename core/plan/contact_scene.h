// SceneOf: the scene that states a model's problem, for code that starts from a scene, such as certificates.

#ifndef RICOCHET_CORE_PLAN_CONTACT_SCENE_H_
#define RICOCHET_CORE_PLAN_CONTACT_SCENE_H_

#include "core/models/pendulum/pendulum.h"
#include "core/models/planar/planar.h"
#include "ricochet/scene.h"

namespace ricochet {

Scene SceneOf(const pendulum::Problem& problem);
Scene SceneOf(const planar::Problem& problem);

}  // namespace ricochet

#endif  // RICOCHET_CORE_PLAN_CONTACT_SCENE_H_
