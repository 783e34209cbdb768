// FitScene: finds numbers of a scene from measured impacts (ricochet/fit.h).

#ifndef RICOCHET_CORE_FIT_FIT_H_
#define RICOCHET_CORE_FIT_FIT_H_

#include "absl/functional/any_invocable.h"
#include "absl/functional/function_ref.h"
#include "absl/status/statusor.h"
#include "core/rows/checked_rows.h"
#include "ricochet/batch.h"
#include "ricochet/fit.h"

namespace ricochet {
namespace fit {

// Solves rows of one batch. Errors: CANCELLED once `stopped` returns true, which is asked on the thread that calls.
using SolveRows = absl::AnyInvocable<absl::StatusOr<BatchSummary>(const BatchRows&, absl::FunctionRef<bool()> stopped)>;
// Says how a fit has its rows solved. The caller decides on which threads.
using OpenRows = absl::FunctionRef<SolveRows(CheckedBatch)>;

}  // namespace fit

// `open_rows` says how rows are solved. `stopped` is asked on this thread. The engine is left to the caller.
// Errors: INVALID_ARGUMENT with every violation of the scene, the unknowns and the data, and for a row without numbers
// at the start; CANCELLED once `stopped` returns true.
absl::StatusOr<FitResponse> FitScene(const FitRequest& request, fit::OpenRows open_rows,
                                     absl::FunctionRef<bool()> stopped);

}  // namespace ricochet

#endif  // RICOCHET_CORE_FIT_FIT_H_
