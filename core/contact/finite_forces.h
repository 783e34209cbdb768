// Finite forces: the accelerations that gravity and the like alone would give a system and its contact.
//
//   q'' = M^-1 Q,   (a_t, a_n) = J q''
//
// A pendulum under a moment has q'' = moment/J0. Bodies under gravity fall freely, so that gravity does not accelerate
// the contact of a pair. A linkage has Q_i = m_i (g_t cos theta_i + g_n sin theta_i), where m_i is the mass moment that
// link i carries. Accelerations are in m/s^2 and rad/s^2. core/contact/reduction.h states the accuracy and the errors.

#ifndef RICOCHET_CORE_CONTACT_FINITE_FORCES_H_
#define RICOCHET_CORE_CONTACT_FINITE_FORCES_H_

#include "core/contact/reduction.h"
#include "ricochet/scene.h"

namespace ricochet {

// Sets `acceleration` and `drift` in the reduction of the scene.
void AddFiniteForces(const Scene& scene, PlanarReduction& reduction);

}  // namespace ricochet

#endif  // RICOCHET_CORE_CONTACT_FINITE_FORCES_H_
