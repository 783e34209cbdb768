// Rates errors: bounds on the errors of a mechanism's velocities after an impact and of the momentum that it takes.
//
//   q'+ = q' + X p,   X = M^-1 J^T,   error(q'+) <= |X| error(p) + error(X) |p| + rounding
//
// error(X) and those of W and the contact velocity are bounds (core/contact/mechanism.h). The error of the impulse p is
// that of the model, for the W and velocity that it was given, and what their own errors make of p: each is moved, one
// by one and both ways, by a step h, and the change of p is taken in proportion and counted twice. That is an estimate.
// docs/theory/mechanism.md derives both. M, J, q' and the coefficients are exact. No bound is known, and the errors are
// infinite, where the impact was not followed to its end, where W is singular but for rows of J that are 0 and a
// mechanism with one free coordinate, and where a step would make W singular.

#ifndef RICOCHET_CORE_ANSWER_RATES_ERRORS_H_
#define RICOCHET_CORE_ANSWER_RATES_ERRORS_H_

#include "absl/functional/function_ref.h"
#include "core/contact/scene_contact.h"
#include "core/plan/demand.h"
#include "ricochet/outcome.h"
#include "ricochet/scene.h"

namespace ricochet {

// Sets the errors of `outcome`, which is that of the scene under `demand`. A scene of another system has none. It takes
// up to 18 further impacts. Once `stopped`, the errors mean nothing.
void SetRatesErrors(const Scene& scene, const SceneContact& contact, const Demand& demand,
                    absl::FunctionRef<bool()> stopped, Outcome& outcome);

}  // namespace ricochet

#endif  // RICOCHET_CORE_ANSWER_RATES_ERRORS_H_
