// Derivatives of an outcome: its numbers by numbers of the scene.
//
// Those of a planar rigid impact are exact. For each number of the scene the contact is differentiated along it
// (core/contact/contact_tangent.h) and the impact along that (core/models/planar/tangent.h), once for either side.
// Where the two sides agree, so do their bits but at a threshold, and the derivative is two-sided. A number that is 0
// is replaced by +-2^-300 for its sides, which changes no digit of them and separates the cases that meet at 0.
// A side does not exist where the scene would break a rule, where the outcome jumps, or where it changes infinitely
// fast. Other impacts have differences (core/answer/differences.h), with an estimated error.
// docs/theory/derivatives.md says what each derivative is accurate to.

#ifndef RICOCHET_CORE_ANSWER_DERIVATIVES_H_
#define RICOCHET_CORE_ANSWER_DERIVATIVES_H_

#include <string>
#include <vector>

#include "absl/functional/function_ref.h"
#include "absl/status/statusor.h"
#include "core/plan/demand.h"
#include "ricochet/demand.h"
#include "ricochet/derivatives.h"
#include "ricochet/error.h"
#include "ricochet/outcome.h"
#include "ricochet/scene.h"

namespace ricochet {

// Every number of an outcome of the scene that has derivatives, and every number of the scene by which it has them. The
// scene must be valid.
DerivativePaths AllDerivativePaths(const Scene& scene);

// Adds a violation for an empty list of paths, "of" or "by", and one for each path that is not `known`; `what` says
// what a path must name.
void CheckPaths(const char* list, const std::vector<std::string>& paths, const std::vector<std::string>& known,
                const char* what, std::vector<Violation>& violations);

// Lists why derivatives cannot be given for a valid scene: excluded effects, or paths that name no such number.
std::vector<Violation> CheckDerivatives(const Scene& scene, const DemandFields& demand, const DerivativePaths& paths);

// Computes them for a request in which CheckDerivatives finds nothing, with the effects that the demand requires.
// Errors: those of OutcomeSamples and DifferencesOf, if the derivatives are not exact or thresholds are asked for.
absl::StatusOr<std::vector<Derivative>> DerivativesOf(const Scene& scene, const Demand& demand,
                                                      const DerivativePaths& paths, absl::FunctionRef<bool()> stopped);

// Those of a scene that has exact ones.
std::vector<Derivative> ExactDerivatives(const Scene& scene, const DerivativePaths& paths);

}  // namespace ricochet

#endif  // RICOCHET_CORE_ANSWER_DERIVATIVES_H_
