// SweepReader: the receiving end of a sweep. Reads the server's stream and checks that nothing is lost.

#ifndef RICOCHET_CLIENT_SWEEP_READER_H_
#define RICOCHET_CLIENT_SWEEP_READER_H_

#include <grpcpp/client_context.h>
#include <grpcpp/support/sync_stream.h>

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <stop_token>

#include "absl/functional/function_ref.h"
#include "absl/status/statusor.h"
#include "ricochet/sweep.h"
#include "ricochet/v1/sweep.pb.h"

namespace ricochet {

// Checks that chunks fit together: in order, without gaps, of the right size, up to the end of the range.
class ChunkChecker {
 public:
  explicit ChunkChecker(const SweepRequest& request);

  // DATA_LOSS if `chunk` is not what must come next.
  absl::Status Check(const SweepChunk& chunk);
  // DATA_LOSS if chunks are missing.
  absl::Status CheckEnd() const;

 private:
  int64_t columns_;
  bool with_regime_;
  int64_t next_index_;
  std::optional<int64_t> end_index_;  // Absent until a chunk tells the size of a grid that this build cannot read.
  bool summarised_ = false;
};

// Thread safety: one thread at a time; the stop token may be triggered from any.
class SweepReader {
 public:
  using Call = grpc::ClientReaderInterface<v1::SweepResponse>;

  // Starts the call that is to answer `request`.
  SweepReader(absl::FunctionRef<std::unique_ptr<Call>(grpc::ClientContext*)> start, const SweepRequest& request,
              std::optional<std::chrono::milliseconds> deadline, std::stop_token stop);
  // Cancels the call if it is still running, and waits for its end.
  ~SweepReader();

  SweepReader(const SweepReader&) = delete;
  SweepReader& operator=(const SweepReader&) = delete;

  // As ResultStream::Source.
  std::optional<absl::StatusOr<SweepChunk>> Next();

 private:
  std::optional<absl::StatusOr<SweepChunk>> End();
  absl::Status Finish();

  grpc::ClientContext context_;
  ChunkChecker checker_;
  std::stop_token stop_;
  std::unique_ptr<Call> reader_;
  v1::SweepResponse message_;
  bool finished_ = false;
  // Last, so that it is gone before what it cancels.
  std::stop_callback<std::function<void()>> cancel_;
};

}  // namespace ricochet

#endif  // RICOCHET_CLIENT_SWEEP_READER_H_
