// Brach's law: the ratio mu_hat of the tangential to the normal impulse is given.
//
// R. M. Brach, J. Appl. Mech. 56 (1989) 133-138, and Mechanical Impact Dynamics, Wiley (1991); Lubarda (2009), Eq.
// (49).
//
//   f = mu_hat tau1,   v1 = -e v0   =>   tau1 = -(1 + e) v0/(wnn + mu_hat wtn)
//
// mu_hat > 0 is an impulse along +t on the striking body, so that friction that opposes slip u > 0 has mu_hat < 0.
// mu_hat is any finite number: the law does not ask whether friction could cause that impulse. mu is not used.

#include <utility>

#include "core/models/laws/impact_law.h"
#include "core/models/laws/impact_law_parts.h"

namespace ricochet::laws {

ImpactLawResult SolveBrach(const PlanarProblem& input, double e, double mu_hat) {
  const NewtonImpact impact(input, e);
  if (auto trivial = impact.Trivial()) return *std::move(trivial);
  return AtMostOne(impact.AtRatio(mu_hat));
}

}  // namespace ricochet::laws
