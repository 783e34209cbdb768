// Bounds for a caller who may stop waiting.

#ifndef RICOCHET_CORE_ENGINE_LOCAL_SOLVER_H_
#define RICOCHET_CORE_ENGINE_LOCAL_SOLVER_H_

#include "absl/functional/function_ref.h"
#include "absl/status/statusor.h"
#include "ricochet/solver.h"

namespace ricochet {

// LocalSolver::Bounds for a caller who may stop waiting: the search of an enclosure, which can take seconds, ends with
// CANCELLED soon after `stopped` says so (core/answer/scene_enclosure.h).
absl::StatusOr<BoundsResponse> AnswerBounds(const BoundsRequest& request, absl::FunctionRef<bool()> stopped);

}  // namespace ricochet

#endif  // RICOCHET_CORE_ENGINE_LOCAL_SOLVER_H_
