// SweepReader: the receiving end of a sweep. It reads the server's stream and checks that no point is missing.

#ifndef RICOCHET_CLIENT_SWEEP_READER_H_
#define RICOCHET_CLIENT_SWEEP_READER_H_

#include <grpcpp/client_context.h>
#include <grpcpp/support/sync_stream.h>

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>

#include "absl/functional/function_ref.h"
#include "absl/status/statusor.h"
#include "client/call_context.h"
#include "ricochet/sweep.h"
#include "ricochet/v1/sweep.pb.h"

namespace ricochet {

// Checks that chunks fit together: they come in order, without gaps, with the right sizes, up to the end of the range.
class ChunkChecker {
 public:
  explicit ChunkChecker(const SweepRequest& request);

  // Errors: DATA_LOSS if `chunk` cannot be the next one.
  absl::Status Check(const SweepChunk& chunk);
  // Errors: DATA_LOSS if chunks are missing at the end of the stream.
  absl::Status CheckEnd() const;

 private:
  int64_t columns_;
  bool with_regime_;
  int64_t next_index_;
  std::optional<int64_t> end_index_;  // Absent until the first chunk, for a grid that this build cannot read.
  bool summarised_ = false;
};

// Reads one sweep from the server, chunk by chunk.
//
// Thread safety: one thread at a time may use a reader; any thread may trigger the stop token.
class SweepReader {
 public:
  using Call = grpc::ClientReaderInterface<v1::SweepResponse>;

  // Starts the call by `start`, which receives the context and returns the stream that answers `request`. The call ends
  // when `options` say so, or `deadline` from now.
  SweepReader(absl::FunctionRef<std::unique_ptr<Call>(grpc::ClientContext*)> start, const SweepRequest& request,
              std::optional<std::chrono::milliseconds> deadline, const CallOptions& options);
  // Cancels the call if it still runs, and waits for its end.
  ~SweepReader();

  SweepReader(const SweepReader&) = delete;
  SweepReader& operator=(const SweepReader&) = delete;

  // Returns the next chunk, an error, or nothing at the end of the sweep; it serves as a ResultStream::Source.
  std::optional<absl::StatusOr<SweepChunk>> Next();

 private:
  std::optional<absl::StatusOr<SweepChunk>> End();
  absl::Status Finish();

  ChunkChecker checker_;
  const CallOptions options_;
  CallContext context_;
  std::unique_ptr<Call> reader_;
  v1::SweepResponse message_;
  bool finished_ = false;
};

}  // namespace ricochet

#endif  // RICOCHET_CLIENT_SWEEP_READER_H_
