// StreamReader: the receiving end of a streaming call. It reads the server's messages and checks that none is missing.

#ifndef RICOCHET_CLIENT_STREAM_READER_H_
#define RICOCHET_CLIENT_STREAM_READER_H_

#include <grpcpp/client_context.h>
#include <grpcpp/support/sync_stream.h>

#include <chrono>
#include <memory>
#include <optional>
#include <utility>

#include "absl/functional/function_ref.h"
#include "absl/status/statusor.h"
#include "client/call_context.h"
#include "proto/wire/status.h"
#include "ricochet/call_options.h"

namespace ricochet {

// Reads one stream of `Wire` messages; the last one, and no other, has a summary. `Checker` has Take(message), which makes
// each message in order a `Chunk`, and CheckEnd(); both give DATA_LOSS if a chunk is missing or wrong.
//
// Thread safety: one thread at a time may use a reader; any thread may trigger the stop token.
template <typename Wire, typename Chunk, typename Checker>
class StreamReader {
 public:
  using Call = grpc::ClientReaderInterface<Wire>;

  // Starts the call by `start`, which receives the context and returns the stream. The call ends when `options` say so, or
  // `deadline` from now.
  StreamReader(absl::FunctionRef<std::unique_ptr<Call>(grpc::ClientContext*)> start, Checker checker,
               std::optional<std::chrono::milliseconds> deadline, const CallOptions& options)
      : checker_(std::move(checker)), options_(options), context_(options, deadline), reader_(start(&context_.get())) {}

  // Cancels the call if it still runs, and waits for its end.
  ~StreamReader() {
    if (finished_) return;
    context_.get().TryCancel();
    static_cast<void>(Finish());
  }

  StreamReader(const StreamReader&) = delete;
  StreamReader& operator=(const StreamReader&) = delete;

  // Returns the next chunk, an error, or nothing at the end of the stream; it serves as a ResultStream::Source.
  std::optional<absl::StatusOr<Chunk>> Next() {
    // Once the caller has asked to stop, chunks that had already arrived are dropped.
    if (!reader_->Read(&message_)) return End();
    if (IsStopped(options_) && !message_.has_summary()) {
      context_.get().TryCancel();
      return End();
    }
    return checker_.Take(message_);
  }

 private:
  std::optional<absl::StatusOr<Chunk>> End() {
    const absl::Status status = Finish();
    const absl::Status complete = checker_.CheckEnd();
    if (IsStopped(options_) && !complete.ok()) return StoppedByCaller();
    if (!status.ok() && !IsStopped(options_)) return status;
    if (!complete.ok()) return complete;
    return std::nullopt;
  }

  // gRPC allows Finish only after all messages were read; after a cancellation few are left.
  absl::Status Finish() {
    finished_ = true;
    while (reader_->Read(&message_)) {
    }
    return FromGrpcStatus(reader_->Finish());
  }

  Checker checker_;
  const CallOptions options_;
  CallContext context_;
  std::unique_ptr<Call> reader_;
  Wire message_;
  bool finished_ = false;
};

}  // namespace ricochet

#endif  // RICOCHET_CLIENT_STREAM_READER_H_
