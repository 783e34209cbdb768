// CoefficientsAtSpeed: the coefficients of a scene at its approach speed.

#ifndef RICOCHET_CORE_CONTACT_COEFFICIENTS_AT_SPEED_H_
#define RICOCHET_CORE_CONTACT_COEFFICIENTS_AT_SPEED_H_

#include <optional>

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

}  // namespace ricochet

#endif  // RICOCHET_CORE_CONTACT_COEFFICIENTS_AT_SPEED_H_
