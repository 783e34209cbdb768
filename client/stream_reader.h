// StreamReader: the receiving end of a streaming call. It reads the server's messages and checks that none is missing.

#ifndef RICOCHET_CLIENT_STREAM_READER_H_
#define RICOCHET_CLIENT_STREAM_READER_H_

#include <chrono>
#include <memory>
#include <optional>
#include <utility>

#include "absl/functional/function_ref.h"
#include "absl/status/statusor.h"
#include "client/call_context.h"
#include "client/stream_call.h"
#include "ricochet/call_options.h"

namespace ricochet {

// Reads one stream of `Wire` messages; the last one, and no other, has a summary. `Checker` has Accept(message), which
// makes each message in order a `Chunk`, and CheckEnd(); both give DATA_LOSS if a chunk is missing or wrong.
//
// Thread safety: one thread at a time may use a reader; any thread may trigger the stop token.
template <typename Wire, typename Chunk, typename Checker>
class StreamReader {
 public:
  using Call = typename StreamCall<Wire>::Reader;

  // Starts the call by `start`, which receives the context and returns the stream. The call ends when `options` say so,
  // or `deadline` from now.
  StreamReader(absl::FunctionRef<std::unique_ptr<Call>(grpc::ClientContext*)> start, Checker checker,
               std::optional<std::chrono::milliseconds> deadline, const CallOptions& options)
      : checker_(std::move(checker)), options_(options), call_(start, deadline, options) {}

  // Returns the next chunk, an error, or nothing at the end of the stream; it serves as a ResultStream::Source.
  std::optional<absl::StatusOr<Chunk>> Next() {
    // Once the caller has asked to stop, chunks that had already arrived are dropped.
    if (!call_.Read(message_)) return End(call_.Finish());
    if (IsStopped(options_) && !message_.has_summary()) return End(call_.Cancel());
    return checker_.Accept(message_);
  }

 private:
  std::optional<absl::StatusOr<Chunk>> End(const absl::Status& status) {
    const absl::Status complete = checker_.CheckEnd();
    if (IsStopped(options_) && !complete.ok()) return StoppedByCaller();
    if (!status.ok() && !IsStopped(options_)) return status;
    if (!complete.ok()) return complete;
    return std::nullopt;
  }

  Checker checker_;
  const CallOptions options_;
  StreamCall<Wire> call_;
  Wire message_;
};

}  // namespace ricochet

#endif  // RICOCHET_CLIENT_STREAM_READER_H_
