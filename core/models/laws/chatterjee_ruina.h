// Chatterjee and Ruina's law: a weighted sum of two plastic impulses, kept inside the friction cone.
//
// A. Chatterjee and A. Ruina, J. Appl. Mech. 65 (1998) 939-951. P_I is the frictionless impulse that ends the approach,
// P_II = -W^-1 (u0, v0) the one that ends approach and slip:
//
//   P = (1 + e) P_I + k (P_II - P_I),   k = 1 + e_t, or the smaller k that puts P on the cone |P_t| = mu P_n
//
// e_t, from -1 (frictionless) to 1, is a coefficient of tangential restitution: 1 reverses the slip of a sphere. For
// 0 <= e <= 1 the law creates no energy. At rank one, P_II is the impulse of minimum norm: velocities do not depend on
// that choice, impulses do. docs/theory/laws.md has the proof and the formulas in coordinates.

#ifndef RICOCHET_CORE_MODELS_LAWS_CHATTERJEE_RUINA_H_
#define RICOCHET_CORE_MODELS_LAWS_CHATTERJEE_RUINA_H_

#include "core/models/laws/impact_law.h"

namespace ricochet::laws {

// e must be >= 0, and e_t in [-1, 1]. There is exactly one solution, or none if wnn <= 0 or if, at rank one and beside
// the range of W, friction drives the contact in. core/models/laws/impact_law.h states units, degenerate inputs and
// accuracy.
ImpactLawResult SolveChatterjeeRuina(const PlanarProblem& input, double e, double e_t);

}  // namespace ricochet::laws

#endif  // RICOCHET_CORE_MODELS_LAWS_CHATTERJEE_RUINA_H_
