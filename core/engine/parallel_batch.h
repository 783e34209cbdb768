// ParallelBatch: the rows of batches of one setup, solved by the thread that asks and by others that help.
//
// All threads take pieces of consecutive rows, and each of them has a BatchRun of its own. Neither the pieces nor the
// threads change the bits of a row or the summary.

#ifndef RICOCHET_CORE_ENGINE_PARALLEL_BATCH_H_
#define RICOCHET_CORE_ENGINE_PARALLEL_BATCH_H_

#include <cstddef>
#include <memory>
#include <mutex>
#include <vector>

#include "absl/functional/function_ref.h"
#include "absl/status/statusor.h"
#include "core/batch/batch_run.h"
#include "ricochet/batch.h"
#include "ricochet/helpers.h"

namespace ricochet {

// Thread safety: one thread at a time.
class ParallelBatch {
 public:
  // Rows that a thread takes at once.
  static constexpr size_t kPiece = LaneRows::kBlock;

  // Helpers are asked once a batch has lasted for a millisecond; null stands for none.
  // Errors: those of BatchRun::Make.
  static absl::StatusOr<std::unique_ptr<ParallelBatch>> Make(const BatchSetup& setup, std::shared_ptr<Helpers> helpers);

  // The columns in or out, whichever are more.
  size_t columns() const { return own_->columns(); }

  // Solves all rows. `stopped` is asked on this thread alone: as BatchRun::Solve says, and every millisecond in which it
  // waits for helpers. An exception that a helper meets is thrown here.
  // Errors: those of BatchRun::Solve.
  absl::StatusOr<BatchSummary> Solve(const BatchRows& rows, absl::FunctionRef<bool()> stopped);

 private:
  class Job;

  ParallelBatch(const BatchSetup& setup, std::unique_ptr<BatchRun> own, std::shared_ptr<Helpers> helpers);
  std::unique_ptr<BatchRun> TakeRun();
  void GiveBack(std::unique_ptr<BatchRun> run);

  const BatchSetup setup_;
  const std::unique_ptr<BatchRun> own_;  // Of the thread that asks.
  const std::shared_ptr<Helpers> helpers_;
  std::mutex mutex_;
  std::vector<std::unique_ptr<BatchRun>> spare_;  // Those of helpers that have gone.
};

}  // namespace ricochet

#endif  // RICOCHET_CORE_ENGINE_PARALLEL_BATCH_H_
