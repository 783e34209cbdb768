// SceneContact: a scene reduced to its contact, with its coefficients at the approach speed.
//
// A request makes it once, when it is validated (core/scene/validate.h); plan, model, bounds and audit receive it.

#ifndef RICOCHET_CORE_CONTACT_SCENE_CONTACT_H_
#define RICOCHET_CORE_CONTACT_SCENE_CONTACT_H_

#include <utility>

#include "core/contact/coefficients_at_speed.h"
#include "core/contact/reduction.h"
#include "ricochet/outcome.h"
#include "ricochet/scene.h"

namespace ricochet {

struct SceneContact {
  // The scene must keep the rules of its own fields. W or the velocity may overflow: see FitsDoubles.
  explicit SceneContact(const Scene& scene)
      : reduction(Reduce(scene)), coefficients(CoefficientsAtSpeed(scene, ApproachSpeed(reduction))) {}

  // `known` is Reduce(scene), for a caller who has it already.
  SceneContact(const Scene& scene, AnyReduction known)
      : reduction(std::move(known)), coefficients(CoefficientsAtSpeed(scene, ApproachSpeed(reduction))) {}

  AnyReduction reduction;
  EffectiveCoefficients coefficients;  // A restitution that is left open is unset.
};

}  // namespace ricochet

#endif  // RICOCHET_CORE_CONTACT_SCENE_CONTACT_H_
