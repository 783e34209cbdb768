// CostReader: the receiving end of a study of cost. It reads the server's stream and checks that no row is missing.

#ifndef RICOCHET_CLIENT_COST_READER_H_
#define RICOCHET_CLIENT_COST_READER_H_

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>

#include "absl/functional/function_ref.h"
#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "client/stream_call.h"
#include "ricochet/call_options.h"
#include "ricochet/cost.h"
#include "ricochet/solver.h"
#include "ricochet/v1/cost.pb.h"

namespace ricochet {

// Checks that chunks fit together: their rows come in order, without gaps, up to the last one, which has the summary.
class CostChecker {
 public:
  // Errors: DATA_LOSS if `message` or `chunk` cannot be the next one.
  absl::StatusOr<CostChunk> Accept(const v1::CostResponse& message);
  absl::Status Check(const CostChunk& chunk);
  // Errors: DATA_LOSS if chunks are missing at the end of the stream.
  absl::Status CheckEnd() const;

 private:
  int64_t rows_ = 0;
  bool summarised_ = false;
};

// Adds a part to the study that the parts before it make: its rows come last, because the summary names rows by place.
void AddPart(CostChunk part, CostChunk& study);

// Returns the parts of a study as one, and shows each to `see` before. Errors: those of the parts, and DATA_LOSS where
// the last has no summary.
absl::StatusOr<CostChunk> WholeStudy(CostStream parts, const std::function<void(const CostChunk&)>& see);

// Reads one stream of messages; the last one, and no other, has a summary.
//
// Thread safety: one thread at a time may use a reader; any thread may trigger the stop token.
class CostReader {
 public:
  using Call = StreamCall<v1::CostResponse>::Reader;

  // Starts the call by `start`, which receives the context and returns the stream. The call ends when `options` say so,
  // or `deadline` from now.
  CostReader(absl::FunctionRef<std::unique_ptr<Call>(grpc::ClientContext*)> start,
             std::optional<std::chrono::milliseconds> deadline, const CallOptions& options)
      : options_(options), call_(start, deadline, options) {}

  // Returns the next chunk, an error, or nothing at the end of the stream; it serves as a ResultStream::Source.
  std::optional<absl::StatusOr<CostChunk>> Next();

 private:
  std::optional<absl::StatusOr<CostChunk>> End(const absl::Status& status);

  CostChecker checker_;
  const CallOptions options_;
  StreamCall<v1::CostResponse> call_;
  v1::CostResponse message_;
};

}  // namespace ricochet

#endif  // RICOCHET_CLIENT_COST_READER_H_
