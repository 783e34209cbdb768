// ParallelBatch: the rows of batches of one setup, solved by the thread that asks and by others that help.
//
// All threads take pieces of consecutive rows, and each of them has a RowSolver of its own. Neither the pieces nor the
// threads change the bits of a row or the summary.

#ifndef RICOCHET_CORE_ENGINE_PARALLEL_BATCH_H_
#define RICOCHET_CORE_ENGINE_PARALLEL_BATCH_H_

#include <algorithm>
#include <cstddef>
#include <memory>

#include "absl/functional/function_ref.h"
#include "absl/status/statusor.h"
#include "core/engine/pool.h"
#include "core/rows/checked_rows.h"
#include "core/rows/row_solver.h"
#include "ricochet/batch.h"
#include "ricochet/helpers.h"

namespace ricochet {

// Thread safety: one thread at a time.
class ParallelBatch {
 public:
  // Helpers are asked once a batch has lasted for a millisecond; null stands for none.
  ParallelBatch(CheckedBatch batch, std::shared_ptr<Helpers> helpers);
  // Errors: those of CheckBatch.
  static absl::StatusOr<std::unique_ptr<ParallelBatch>> Make(const BatchSetup& setup, std::shared_ptr<Helpers> helpers);

  // The columns in or out, whichever are more.
  size_t columns() const { return std::max(batch_.fields.size(), batch_.columns.size()); }

  // Solves all rows. `stopped` is asked on this thread alone: as RowSolver::Solve says, and every millisecond in which
  // it waits for helpers. An exception that a helper meets is thrown here. Errors: INVALID_ARGUMENT if the columns do
  // not fit, CANCELLED once `stopped` returns true.
  absl::StatusOr<BatchSummary> Solve(const BatchRows& rows, absl::FunctionRef<bool()> stopped);

 private:
  size_t PieceOf(size_t rows) const;

  const CheckedBatch batch_;
  const std::shared_ptr<Helpers> helpers_;
  Pool<RowSolver> solvers_;
  const Pool<RowSolver>::Taken own_;  // The thread that asks uses it.
};

}  // namespace ricochet

#endif  // RICOCHET_CORE_ENGINE_PARALLEL_BATCH_H_
