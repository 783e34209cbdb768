// Derivatives of an outcome from its values beside the scene, for impacts whose kernels have no dual numbers: in space,
// with compliance, in time, and by the impact laws of others.
//
// A polynomial through the outcome at the scene and at six neighbours on a side, or on both, is differentiated. Steps
// shrink until the error stops falling. It is estimated: what the farthest neighbours change, and the errors of the
// outcomes over the step. Neighbours on a side must share one course of the impact, that of a scene next to this one;
// so a threshold at the number keeps its sides apart, and one nearby only makes steps shorter.
// docs/theory/derivatives.md says more.

#ifndef RICOCHET_CORE_ANSWER_DIFFERENCES_H_
#define RICOCHET_CORE_ANSWER_DIFFERENCES_H_

#include <vector>

#include "absl/functional/function_ref.h"
#include "absl/status/statusor.h"
#include "core/plan/demand.h"
#include "ricochet/derivatives.h"
#include "ricochet/scene.h"

namespace ricochet {

// The scene and the paths are as for DerivativesOf (core/answer/derivatives.h). The outcomes are computed as exactly as
// the models can, with the effects that the demand requires.
// Errors: those of SolveScene for the scene itself, and CANCELLED once `stopped` says true.
absl::StatusOr<std::vector<Derivative>> DifferencesOf(const Scene& scene, const Demand& demand,
                                                      const DerivativePaths& paths, absl::FunctionRef<bool()> stopped);

}  // namespace ricochet

#endif  // RICOCHET_CORE_ANSWER_DIFFERENCES_H_
