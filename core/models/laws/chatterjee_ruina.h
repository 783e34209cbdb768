// Chatterjee and Ruina's algebraic law: a weighted sum of two plastic impulses, kept inside the friction cone.
//
// A. Chatterjee and A. Ruina, A new algebraic rigid-body collision law based on impulse space considerations,
// J. Appl. Mech. 65 (1998) 939-951. With P_I the frictionless impulse that ends the approach and P_II = -W^-1 (u0, v0)
// the one that ends approach and slip,
//
//   P = (1 + e) P_I + k (P_II - P_I)
//   k = 1 + e_t   if that P lies in the cone |P_t| <= mu P_n, else
//   k = kappa     = mu (1 + e) n.P_I/(|P_II,t| - mu n.(P_II - P_I)),   which puts P on the cone
//
// e_t from -1 (frictionless) to 1 is a coefficient of tangential restitution: 1 reverses the slip of a sphere. For
// 0 <= e <= 1 no energy is created: in the norm of W, P - P_II = e P_I + (k - 1)(P_II - P_I) and P_I is orthogonal to
// P_II - P_I, so that (k - 1)^2 <= 1 is enough, and 0 <= kappa <= 1 + e_t.
//
// In coordinates, with H = u0 wnn - v0 wtn, s = sgn(H), c = -(1 + e) v0:
//
//   P_I = (0, -v0/wnn),  P_II - P_I = (H/det W) (-1, wtn/wnn),  v1 = -e v0,  u1 = -(e_t H + e v0 wtn)/wnn
//   in the cone iff (1 + e_t) |H| (wnn - mu s wtn) <= mu c det W
//   on the cone: f = -s mu tau1, tau1 = c/(wnn - mu s wtn)                                        (kappa, simplified)
//
// Rank one: W has no inverse, and any P_II on a line ends approach and slip. The one of minimum norm is taken,
// P_II = (-v0/(wtt + wnn)) (wtn/wnn, 1). Velocities do not depend on that choice, u1 = -e u0; impulses do, and differ
// from the limit of rank two, which depends on how det W and H vanish.

#ifndef RICOCHET_CORE_MODELS_LAWS_CHATTERJEE_RUINA_H_
#define RICOCHET_CORE_MODELS_LAWS_CHATTERJEE_RUINA_H_

#include "core/models/laws/impact_law.h"

namespace ricochet::laws {

// e >= 0; -1 <= e_t <= 1. Exactly one solution, but where wnn <= 0. Units, degenerate inputs and accuracy:
// core/models/laws/impact_law.h.
ImpactLawResult SolveChatterjeeRuina(const PlanarImpactInput& input, double e, double e_t);

}  // namespace ricochet::laws

#endif  // RICOCHET_CORE_MODELS_LAWS_CHATTERJEE_RUINA_H_
