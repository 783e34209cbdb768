// StreamCall: one streaming call to a server.

#ifndef RICOCHET_CLIENT_STREAM_CALL_H_
#define RICOCHET_CLIENT_STREAM_CALL_H_

#include <grpcpp/client_context.h>
#include <grpcpp/support/sync_stream.h>

#include <chrono>
#include <memory>
#include <optional>

#include "absl/functional/function_ref.h"
#include "absl/status/status.h"
#include "client/call_context.h"
#include "proto/wire/status.h"
#include "ricochet/call_options.h"

namespace ricochet {

// Thread safety: one thread at a time may use a call; any thread may trigger the stop token.
template <typename Message>
class StreamCall {
 public:
  using Reader = grpc::ClientReaderInterface<Message>;

  // Starts the call by `start`, which receives the context and returns the stream. The call ends when `options` say so,
  // or `deadline` from now.
  StreamCall(absl::FunctionRef<std::unique_ptr<Reader>(grpc::ClientContext*)> start,
             std::optional<std::chrono::milliseconds> deadline, const CallOptions& options)
      : context_(options, deadline), reader_(start(&context_.get())) {}

  // Cancels the call if it still runs, and waits for its end.
  ~StreamCall() {
    if (!finished_) static_cast<void>(Cancel());
  }

  StreamCall(const StreamCall&) = delete;
  StreamCall& operator=(const StreamCall&) = delete;

  // Returns false at the end of the stream; Finish then says why it ended.
  bool Read(Message& message) { return reader_->Read(&message); }

  // Cancels the call and returns its status.
  absl::Status Cancel() {
    context_.get().TryCancel();
    return Finish();
  }

  // Returns the status of a call whose messages were all read, or that was cancelled. Call it once.
  absl::Status Finish() {
    finished_ = true;
    // gRPC allows Finish only after all messages were read; after a cancellation few are left.
    Message rest;
    while (reader_->Read(&rest)) {
    }
    return FromGrpcStatus(reader_->Finish());
  }

 private:
  CallContext context_;
  std::unique_ptr<Reader> reader_;
  bool finished_ = false;
};

}  // namespace ricochet

#endif  // RICOCHET_CLIENT_STREAM_CALL_H_
