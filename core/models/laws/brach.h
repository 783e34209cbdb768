// Brach's law: the ratio mu_hat of the tangential to the normal impulse is given.
//
// R. M. Brach, J. Appl. Mech. 56 (1989) 133-138, and Mechanical Impact Dynamics, Wiley (1991); Lubarda (2009), Eq.
// (49).
//
//   f = mu_hat tau1,   v1 = -e v0   =>   tau1 = -(1 + e) v0/(wnn + mu_hat wtn)
//
// mu_hat > 0 is an impulse along +t on the striking body, so that friction that opposes slip u > 0 has mu_hat < 0.
// mu_hat is any finite number: the law does not ask whether friction could cause that impulse. mu is not used.

#ifndef RICOCHET_CORE_MODELS_LAWS_BRACH_H_
#define RICOCHET_CORE_MODELS_LAWS_BRACH_H_

#include "core/models/laws/impact_law.h"

namespace ricochet::laws {

// e must be >= 0. There is one solution, or none if wnn + mu_hat wtn <= 0. core/models/laws/impact_law.h states units,
// degenerate inputs and accuracy.
ImpactLawResult SolveBrach(const PlanarProblem& input, double e, double mu_hat);

}  // namespace ricochet::laws

#endif  // RICOCHET_CORE_MODELS_LAWS_BRACH_H_
