// Whittaker's law: friction at its limit, in one direction, for the whole impact.
//
// E. T. Whittaker, A Treatise on the Analytical Dynamics of Particles and Rigid Bodies, Cambridge (1904; 4th ed. 1937),
// chapter VIII, on impact; the theory that Lubarda (2009) sets against his Eq. (50). The tangential impulse opposes
// the slip before the impact:
//
//   f = -mu sgn(u0) tau1,   v1 = -e v0   =>   tau1 = -(1 + e) v0/(wnn - mu sgn(u0) wtn)
//
// Slip that stops or reverses on the way is not noticed: friction then does positive work, and the law can create
// energy. Convention at u0 = 0, where there is no slip to oppose: sgn(0) = 0, so f = 0.

#ifndef RICOCHET_CORE_MODELS_LAWS_WHITTAKER_H_
#define RICOCHET_CORE_MODELS_LAWS_WHITTAKER_H_

#include "core/models/laws/impact_law.h"

namespace ricochet::laws {

// e >= 0. One solution; none where wnn - mu sgn(u0) wtn <= 0: friction would hold the contact in approach for ever
// (self-locking) and no tau1 > 0 ends it. At rank one velocities are those of any other friction. Units, degenerate
// inputs and accuracy: core/models/laws/impact_law.h.
ImpactLawResult SolveWhittaker(const PlanarImpactInput& input, double e);

}  // namespace ricochet::laws

#endif  // RICOCHET_CORE_MODELS_LAWS_WHITTAKER_H_
