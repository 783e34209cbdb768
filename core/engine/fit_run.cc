#include "core/engine/fit_run.h"

#include <utility>

#include "core/engine/parallel_batch.h"
#include "core/fit/fit.h"

namespace ricochet {

absl::StatusOr<FitResponse> RunFit(const FitRequest& request, std::shared_ptr<Helpers> helpers,
                                   absl::FunctionRef<bool()> stopped) {
  const auto open_rows = [&helpers](CheckedBatch batch) -> fit::SolveRows {
    return [rows = std::make_unique<ParallelBatch>(std::move(batch), helpers)](
               const BatchRows& all, absl::FunctionRef<bool()> is_stopped) { return rows->Solve(all, is_stopped); };
  };
  return FitScene(request, open_rows, stopped);
}

}  // namespace ricochet
