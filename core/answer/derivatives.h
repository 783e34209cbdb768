// Derivatives of an outcome: its numbers by numbers of the scene.
//
// A planar rigid impact has exact derivatives (core/answer/exact_derivatives.h). Other impacts have differences
// (core/answer/differences.h), with an estimated error. docs/theory/derivatives.md says what each derivative is
// accurate to.

#ifndef RICOCHET_CORE_ANSWER_DERIVATIVES_H_
#define RICOCHET_CORE_ANSWER_DERIVATIVES_H_

#include <vector>

#include "absl/functional/function_ref.h"
#include "absl/status/statusor.h"
#include "core/plan/demand.h"
#include "ricochet/derivatives.h"
#include "ricochet/outcome.h"
#include "ricochet/scene.h"

namespace ricochet {

// Computes them for a request in which CheckDerivatives finds nothing, with the effects that the demand requires.
// Errors: those of OutcomeSamples and DifferencesOf, if the derivatives are not exact or thresholds are asked for.
absl::StatusOr<std::vector<Derivative>> DerivativesOf(const Scene& scene, const Demand& demand,
                                                      const DerivativePaths& paths, absl::FunctionRef<bool()> stopped);

}  // namespace ricochet

#endif  // RICOCHET_CORE_ANSWER_DERIVATIVES_H_
