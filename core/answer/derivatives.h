// Derivatives of an outcome: its numbers by numbers of the scene.
//
// A planar rigid impact has exact derivatives (core/answer/exact_derivatives.h). Other impacts have differences
// (core/answer/differences.h), with an estimated error. docs/theory/derivatives.md says what each derivative is
// accurate to. Where asked for, each comes with the nearest thresholds (FindThresholds).

#ifndef RICOCHET_CORE_ANSWER_DERIVATIVES_H_
#define RICOCHET_CORE_ANSWER_DERIVATIVES_H_

#include <string>
#include <vector>

#include "absl/functional/function_ref.h"
#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "core/answer/differences.h"
#include "core/plan/demand.h"
#include "ricochet/derivatives.h"
#include "ricochet/outcome.h"
#include "ricochet/scene.h"

namespace ricochet {

// Computes them for a request in which CheckDerivatives finds nothing, with the effects that the demand requires.
// Errors: those of OutcomeSamples and DifferencesOf, if the derivatives are not exact or thresholds are asked for.
absl::StatusOr<std::vector<Derivative>> DerivativesOf(const Scene& scene, const Demand& demand,
                                                      const DerivativePaths& paths, absl::FunctionRef<bool()> stopped);

// Sets the thresholds nearest to the scene, Derivative::below and Derivative::above, in each derivative by a number of
// `by`; `derivatives` has those of the first number of the outcome by every number first. Distances grow from next to
// the scene until the course changes, and the change is then bisected. Errors: CANCELLED once the source is stopped.
absl::Status FindThresholds(const SampleSource& source, const Scene& scene, const std::vector<std::string>& by,
                            std::vector<Derivative>& derivatives);

}  // namespace ricochet

#endif  // RICOCHET_CORE_ANSWER_DERIVATIVES_H_
