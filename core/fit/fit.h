// FitScene: finds numbers of a scene from measured impacts (ricochet/fit.h).

#ifndef RICOCHET_CORE_FIT_FIT_H_
#define RICOCHET_CORE_FIT_FIT_H_

#include "absl/functional/function_ref.h"
#include "absl/status/statusor.h"
#include "ricochet/fit.h"

namespace ricochet {
// `stopped` is asked before each row. The engine is left to the caller.
// Errors: INVALID_ARGUMENT with every violation of the scene, the unknowns and the data, and for a row without numbers
// at the start; CANCELLED once `stopped` returns true.
absl::StatusOr<FitResponse> FitScene(const FitRequest& request, absl::FunctionRef<bool()> stopped);

}  // namespace ricochet

#endif  // RICOCHET_CORE_FIT_FIT_H_
