// SceneContact: a scene reduced to its contact, with its coefficients at the approach speed.
//
// A request makes it once, when it is validated (core/scene/validate.h); plan, model, bounds and audit receive it.

#ifndef RICOCHET_CORE_CONTACT_SCENE_CONTACT_H_
#define RICOCHET_CORE_CONTACT_SCENE_CONTACT_H_

#include <optional>
#include <utility>

#include "core/contact/reduction.h"
#include "core/numerics/affine_interval.h"
#include "ricochet/outcome.h"
#include "ricochet/scene.h"

namespace ricochet {

// The factor at `speed` >= 0, in m/s; 1 if there is no dependence.
double FactorAt(const std::optional<SpeedDependence>& dependence, double speed);

// Encloses the factor of each speed, all >= 0.
AffineInterval FactorAt(const std::optional<SpeedDependence>& dependence, const AffineInterval& speed);

// True if a coefficient of the scene depends on the speed.
inline bool DependsOnSpeed(const Scene& scene) {
  return scene.friction.by_speed.has_value() || scene.restitution_by_speed.has_value();
}

// The scene's coefficients, each multiplied by its factor. A restitution that is left open is unset.
EffectiveCoefficients CoefficientsAtSpeed(const Scene& scene, double speed);

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
