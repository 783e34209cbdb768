// Converts batches to their protos and back. Columns are copied once: outputs are written into the message itself.

#ifndef RICOCHET_PROTO_WIRE_BATCH_H_
#define RICOCHET_PROTO_WIRE_BATCH_H_

#include <cstddef>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "ricochet/batch.h"
#include "ricochet/v1/batch.pb.h"

namespace ricochet {

v1::BatchSetup ToProto(const BatchSetup& setup);
BatchSetup FromProto(const v1::BatchSetup& proto);
v1::BatchSummary ToProto(const BatchSummary& summary);
BatchSummary FromProto(const v1::BatchSummary& proto);

// Puts the rows [first, first + count) of the input columns into the request.
void SetInputs(const BatchRows& rows, size_t first, size_t count, v1::SolveBatchRequest& request);

// Copies the answer to the rows [first, first + count) into the caller's columns.
// Errors: DATA_LOSS if the answer has another number of columns or rows.
absl::Status CopyOutputs(const v1::SolveBatchResponse& response, size_t first, size_t count, const BatchRows& rows);

// BatchExchange: the rows of a request and of its answer, as a Solver takes them.
class BatchExchange {
 public:
  // Takes the inputs of `request`, which must outlive their use.
  // Errors: INVALID_ARGUMENT if a column is no list of doubles.
  absl::Status OpenInputs(const v1::SolveBatchRequest& request);

  // Makes room for `columns` columns in `response`, which must outlive their use.
  void OpenOutputs(size_t columns, v1::SolveBatchResponse& response);

  // The length of the first column.
  size_t row_count() const { return rows_.inputs.empty() ? 0 : rows_.inputs.front().size(); }
  const BatchRows& rows() const { return rows_; }

  // Completes the response once the rows are solved.
  void Close(const BatchSummary& summary, const EngineInfo& engine, v1::SolveBatchResponse& response);

  // Lets `session`, whose setup has `columns` columns, answer `request`: all of the above. The response is empty after
  // an error. Errors: those of OpenInputs and of BatchSession.
  absl::StatusOr<BatchSummary> Answer(BatchSession& session, size_t columns, const v1::SolveBatchRequest& request,
                                      v1::SolveBatchResponse& response);

 private:
  BatchRows rows_;
  std::vector<std::vector<double>> aligned_;  // Copies of input columns that do not lie in memory as doubles do.
  std::vector<Regime> regimes_;
  std::vector<RowStatus> statuses_;
};

}  // namespace ricochet

#endif  // RICOCHET_PROTO_WIRE_BATCH_H_
