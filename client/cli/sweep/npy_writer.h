// NpyWriter: a sweep as an array of records in NumPy's format NPY, for numpy.load.

#ifndef RICOCHET_CLIENT_CLI_SWEEP_NPY_WRITER_H_
#define RICOCHET_CLIENT_CLI_SWEEP_NPY_WRITER_H_

#include <memory>
#include <string>

#include "absl/status/statusor.h"
#include "client/cli/text/axis_cursor.h"
#include "ricochet/sweep.h"

namespace ricochet::cli {

// A SweepWriter: the header before the first point of the range, and then one record for each point. The fields of a
// record are index (int64), the axes and the columns by their paths (float64), and regime and status (uint8, the
// numbers of ricochet.v1.Regime and RowStatus) if they were asked for.
class NpyWriter {
 public:
  explicit NpyWriter(const SweepRequest& request)
      : request_(std::make_shared<SweepRequest>(request)), cursor_(request_->grid) {}

  absl::StatusOr<std::string> operator()(const SweepChunk& chunk);

 private:
  std::shared_ptr<const SweepRequest> request_;  // Shared, because a writer is copied and the cursor points to it.
  AxisCursor cursor_;
};

}  // namespace ricochet::cli

#endif  // RICOCHET_CLIENT_CLI_SWEEP_NPY_WRITER_H_
