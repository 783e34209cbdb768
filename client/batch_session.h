// RemoteBatches: the batches of one session, asked of a server over one call that stays open.
//
// A batch that is longer than a piece is sent piece by piece, each after the answer to the one before. A call that
// breaks off is replaced by another, which goes on at the first piece without an answer.

#ifndef RICOCHET_CLIENT_BATCH_SESSION_H_
#define RICOCHET_CLIENT_BATCH_SESSION_H_

#include <grpcpp/client_context.h>
#include <grpcpp/support/sync_stream.h>

#include <algorithm>
#include <cstddef>
#include <functional>
#include <memory>
#include <optional>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "client/attempts.h"
#include "client/call_context.h"
#include "ricochet/batch.h"
#include "ricochet/call_options.h"
#include "ricochet/client_options.h"
#include "ricochet/limits.h"
#include "ricochet/v1/batch.pb.h"

namespace ricochet {

// The most rows of one message, at least one: so many that its columns, in or out, take a mebibyte, and that the client
// receives their answer. Servers take more, but smaller pieces keep the memory of both sides small.
size_t RowsOfAPiece(const BatchSetup& setup, int64_t max_receive_bytes);
// The most rows of one message to a server that has these limits, at least one.
size_t RowsOfAPiece(const BatchSetup& setup, const Limits& limits);

class RemoteBatches final : public BatchSession::Worker {
 public:
  using Stream = grpc::ClientReaderWriterInterface<v1::SolveBatchRequest, v1::SolveBatchResponse>;
  // Starts a call of the server with this number.
  using Start = std::function<std::unique_ptr<Stream>(size_t server, grpc::ClientContext* context)>;

  // Asks a server for the most rows of one message.
  using AskMostRows = std::function<absl::StatusOr<size_t>()>;

  // `servers` must outlive this object.
  RemoteBatches(const BatchSetup& setup, Start start, AskMostRows ask_most_rows, PreferredServer& servers,
                const RetryPolicy& policy, int64_t max_receive_bytes, CallOptions options);
  ~RemoteBatches() override;

  absl::StatusOr<BatchSummary> Solve(const BatchRows& rows) override;
  absl::Status CheckSize(size_t /*rows*/) const override { return absl::OkStatus(); }
  const EngineInfo& engine() const override { return engine_; }

 private:
  // One call, from its start to its end.
  struct Call {
    Call(const CallOptions& options, const Start& start, size_t server)
        : context(options, std::nullopt), stream(start(server, &context.get())) {}
    CallContext context;
    std::unique_ptr<Stream> stream;
    bool has_setup = false;
  };

  // The rows [first, end) of a batch that still have no answer, and the summary of those before them.
  struct Remaining {
    const BatchRows& rows;
    size_t first;
    size_t end;
    BatchSummary summary;
  };

  size_t PieceAt(size_t first, size_t end) const { return std::min(piece_, end - first); }
  bool Write(const BatchRows& rows, size_t first, size_t count);
  absl::Status Exchange(Remaining& remaining, Attempts& attempts);
  bool MakePiecesSmaller(const absl::Status& status);
  absl::Status ReadAnswer(Remaining& remaining);
  // Ends the call and returns its status.
  absl::Status End();

  const v1::BatchSetup setup_;
  const size_t fields_;
  const size_t columns_;
  size_t piece_;  // Rows of a message.
  const Start start_;
  const AskMostRows ask_most_rows_;
  PreferredServer& servers_;
  const RetryPolicy policy_;
  const CallOptions options_;
  std::optional<Call> call_;  // Absent before the first batch and after a failure.
  v1::SolveBatchRequest request_;
  v1::SolveBatchResponse response_;
  EngineInfo engine_;
};

}  // namespace ricochet

#endif  // RICOCHET_CLIENT_BATCH_SESSION_H_
