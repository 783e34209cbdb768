// Kane and Levinson's law: Coulomb's law between the whole impulse and the slip after the impact.
//
// T. R. Kane and D. A. Levinson, Dynamics: Theory and Applications, McGraw-Hill (1985); here static and kinetic
// friction are equal. v1 = -e v0, and either
//
//   stick   u1 = 0,  |f| <= mu tau1            or
//   slip    u1 != 0, f = -mu sgn(u1) tau1
//
// The law ignores the slip on the way, so that it can create energy: in Kane's paradox a double pendulum rebounds with
// several times the energy it had. A positive definite W has exactly one solution. At rank one there may be none,
// because friction locks a contact that e > 0 asks to rebound, or a range of impulses, where u1 = 0 whatever they are.
// docs/theory/laws.md has the proof.

#ifndef RICOCHET_CORE_MODELS_LAWS_KANE_LEVINSON_H_
#define RICOCHET_CORE_MODELS_LAWS_KANE_LEVINSON_H_

#include "core/models/laws/impact_law.h"

namespace ricochet::laws {

// e must be >= 0. Of a range, the solution is the end whose friction does the least work: it opposes the slip.
// core/models/laws/impact_law.h states units, degenerate inputs and accuracy.
ImpactLawResult SolveKaneLevinson(const PlanarProblem& input, double e);

}  // namespace ricochet::laws

#endif  // RICOCHET_CORE_MODELS_LAWS_KANE_LEVINSON_H_
