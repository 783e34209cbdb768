// Derivatives of bounds by numbers of the scene: the ends of the ranges, and the critical coefficients of friction.
//
// They are differences (core/answer/differences.h), with an estimated error. Bounds do not depend on restitution.

#ifndef RICOCHET_CORE_ANSWER_BOUNDS_DERIVATIVES_H_
#define RICOCHET_CORE_ANSWER_BOUNDS_DERIVATIVES_H_

#include <vector>

#include "absl/functional/function_ref.h"
#include "absl/status/statusor.h"
#include "ricochet/bounds.h"
#include "ricochet/derivatives.h"
#include "ricochet/error.h"
#include "ricochet/scene.h"

namespace ricochet {

// Lists the paths that name no number of the bounds or of the valid scene.
std::vector<Violation> CheckBoundsDerivatives(const Scene& scene, const DerivativePaths& paths);

// `bounds` are those of the scene, and nothing is wrong with the paths.
// Errors: CANCELLED once `stopped` says true.
absl::StatusOr<std::vector<Derivative>> BoundsDerivativesOf(const Scene& scene, const Bounds& bounds,
                                                            const DerivativePaths& paths,
                                                            absl::FunctionRef<bool()> stopped);

}  // namespace ricochet

#endif  // RICOCHET_CORE_ANSWER_BOUNDS_DERIVATIVES_H_
