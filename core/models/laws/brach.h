// Brach's law: the ratio of the two impulses is given.
//
// R. M. Brach, Rigid body collisions, J. Appl. Mech. 56 (1989) 133-138, and Mechanical Impact Dynamics, Wiley (1991).
// The ratio is the tangential coefficient of Lubarda (2009) Eq. (49), with its sign, Coefficients.tangential of
// ricochet/outcome.h: mu_hat > 0 is an impulse along +t on the striking body, so friction that opposes slip u > 0 has
// mu_hat < 0.
//
//   f = mu_hat tau1,   v1 = -e v0   =>   tau1 = -(1 + e) v0/(wnn + mu_hat wtn)
//
// mu_hat is any finite number: the law does not ask whether friction could do that, nor at what energy. mu is not used.

#ifndef RICOCHET_CORE_MODELS_LAWS_BRACH_H_
#define RICOCHET_CORE_MODELS_LAWS_BRACH_H_

#include "core/models/laws/impact_law.h"

namespace ricochet::laws {

// e >= 0. One solution; none where wnn + mu_hat wtn <= 0. Units, degenerate inputs and accuracy:
// core/models/laws/impact_law.h.
ImpactLawResult SolveBrach(const PlanarImpactInput& input, double e, double mu_hat);

}  // namespace ricochet::laws

#endif  // RICOCHET_CORE_MODELS_LAWS_BRACH_H_
