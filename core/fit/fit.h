// FitScene: finds numbers of a scene from measured impacts (ricochet/fit.h).

#ifndef RICOCHET_CORE_FIT_FIT_H_
#define RICOCHET_CORE_FIT_FIT_H_

#include "absl/functional/function_ref.h"
#include "absl/status/statusor.h"
#include "core/fit/solve_rows.h"
#include "ricochet/fit.h"

namespace ricochet {

// `open_rows` says how rows are solved. `stopped` is asked on this thread. The engine is left to the caller.
// Errors: INVALID_ARGUMENT with every violation of the scene, the unknowns and the data, and for a row without numbers
// at the start; CANCELLED once `stopped` returns true.
absl::StatusOr<FitResponse> FitScene(const FitRequest& request, fit::OpenRows open_rows,
                                     absl::FunctionRef<bool()> stopped);

}  // namespace ricochet

#endif  // RICOCHET_CORE_FIT_FIT_H_
