// Whittaker's law: friction acts at its limit, in one direction, for the whole impact.
//
// E. T. Whittaker, Analytical Dynamics of Particles and Rigid Bodies, Cambridge (1904), chapter VIII; Lubarda (2009),
// Eq. (50). The tangential impulse opposes the slip before the impact:
//
//   f = -mu sgn(u0) tau1,   v1 = -e v0   =>   tau1 = -(1 + e) v0/(wnn - mu sgn(u0) wtn)
//
// The law ignores slip that stops or reverses on the way: friction then does positive work, and the law can create
// energy. sgn(0) = 0, so that f = 0 if there is no slip before the impact.

#ifndef RICOCHET_CORE_MODELS_LAWS_WHITTAKER_H_
#define RICOCHET_CORE_MODELS_LAWS_WHITTAKER_H_

#include "core/models/laws/impact_law.h"

namespace ricochet::laws {

// e must be >= 0. There is one solution, or none if wnn - mu sgn(u0) wtn <= 0, because no tau1 > 0 then ends the
// approach (self-locking). core/models/laws/impact_law.h states units, degenerate inputs and accuracy.
ImpactLawResult SolveWhittaker(const PlanarProblem& input, double e);

}  // namespace ricochet::laws

#endif  // RICOCHET_CORE_MODELS_LAWS_WHITTAKER_H_
