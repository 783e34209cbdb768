// Rates errors: bounds on the errors of a mechanism's velocities after an impact and of the momentum that it takes.
//
//   q'+ = q' + X p,   X = M^-1 J^T,   error(q'+) <= |X| error(p) + error(X) |p| + rounding
//
// M, J, q' and the coefficients are exact. The error of the impulse p is that of the model, for the W and the velocity
// that it was given, and what the errors of these two make of p (core/answer/impulse_changes.h). Their errors and that
// of X are bounded (core/contact/mechanism.h). The sum is proved where Accuracy::kind says so of the model; it is
// infinite where no bound is known. docs/theory/mechanism.md derives it.

#ifndef RICOCHET_CORE_ANSWER_RATES_ERRORS_H_
#define RICOCHET_CORE_ANSWER_RATES_ERRORS_H_

#include "core/contact/scene_contact.h"
#include "ricochet/outcome.h"
#include "ricochet/scene.h"

namespace ricochet {

// Sets the errors of `outcome`, which is that of the scene with all of its detail. A scene of another system has none.
void SetRatesErrors(const Scene& scene, const SceneContact& contact, Outcome& outcome);

}  // namespace ricochet

#endif  // RICOCHET_CORE_ANSWER_RATES_ERRORS_H_
