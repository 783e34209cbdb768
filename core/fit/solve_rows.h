// SolveRows: how a fit has its rows solved. The caller decides on which threads.

#ifndef RICOCHET_CORE_FIT_SOLVE_ROWS_H_
#define RICOCHET_CORE_FIT_SOLVE_ROWS_H_

#include "absl/functional/any_invocable.h"
#include "absl/functional/function_ref.h"
#include "absl/status/statusor.h"
#include "core/rows/checked_rows.h"
#include "ricochet/batch.h"

namespace ricochet::fit {

// Solves rows of one batch. Errors: CANCELLED once `stopped` returns true, which is asked on the thread that calls.
using SolveRows = absl::AnyInvocable<absl::StatusOr<BatchSummary>(const BatchRows&, absl::FunctionRef<bool()> stopped)>;
using OpenRows = absl::FunctionRef<SolveRows(CheckedBatch)>;

}  // namespace ricochet::fit

#endif  // RICOCHET_CORE_FIT_SOLVE_ROWS_H_
