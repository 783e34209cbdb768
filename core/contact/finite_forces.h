// Finite forces: what gravity and the like alone would do to a system and to its contact.
//
//   q'' = M^-1 Q,   (a_t, a_n) = J q''
//
// A pendulum under a moment: q'' = moment/J0. Bodies under gravity: each falls, so that the contact of a pair does not
// feel it. A linkage: Q_i = m_i (g_t cos theta_i + g_n sin theta_i), m_i the mass moment that link i carries.
// Errors and accuracy: those of core/contact/reduction.h.

#ifndef RICOCHET_CORE_CONTACT_FINITE_FORCES_H_
#define RICOCHET_CORE_CONTACT_FINITE_FORCES_H_

#include "core/contact/reduction.h"
#include "ricochet/scene.h"

namespace ricochet {

// Sets `acceleration` and `drift` of the scene's reduction.
void AddFiniteForces(const Scene& scene, PlanarReduction& reduction);

}  // namespace ricochet

#endif  // RICOCHET_CORE_CONTACT_FINITE_FORCES_H_
