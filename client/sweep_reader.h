// SweepReader: the receiving end of a sweep. It reads the server's stream, checks that no point is missing or damaged,
// and goes on with another call where one breaks off.

#ifndef RICOCHET_CLIENT_SWEEP_READER_H_
#define RICOCHET_CLIENT_SWEEP_READER_H_

#include <grpcpp/client_context.h>
#include <grpcpp/support/sync_stream.h>

#include <chrono>
#include <functional>
#include <memory>
#include <optional>

#include "absl/status/statusor.h"
#include "client/attempts.h"
#include "client/chunk_checker.h"
#include "client/stream_call.h"
#include "ricochet/call_options.h"
#include "ricochet/client_options.h"
#include "ricochet/sweep.h"
#include "ricochet/v1/sweep.pb.h"

namespace ricochet {

// The chunks, joined, and the summary are those of a call that nothing disturbed.
//
// Thread safety: one thread at a time may use a reader; any thread may trigger the stop token.
class SweepReader {
 public:
  using Call = StreamCall<v1::SweepResponse>::Reader;
  // Asks a server, by its number in the list.
  using Start = std::function<std::unique_ptr<Call>(size_t server, grpc::ClientContext*, const v1::SweepRequest&)>;
  using Sleeper = std::function<bool(std::chrono::milliseconds, const CallOptions&)>;

  // All calls together end when `options` say so, or `deadline` from now. `sleep` waits as Pause does.
  SweepReader(const SweepRequest& request, Start start, PreferredServer& servers, const RetryPolicy& policy,
              std::optional<std::chrono::milliseconds> deadline, const CallOptions& options, Sleeper sleep = Pause);

  // Returns the next chunk, an error, or nothing at the end of the sweep; it serves as a ResultStream::Source.
  std::optional<absl::StatusOr<SweepChunk>> Next();

 private:
  void Ask();
  absl::StatusOr<SweepChunk> Received();
  std::optional<absl::Status> AfterEnd();

  ChunkChecker checker_;
  v1::SweepRequest request_;  // Its first_index is the next point.
  const Start start_;
  const Sleeper sleep_;
  const CallOptions options_;
  const RetryPolicy policy_;
  const int most_starts_;  // The most attempts before the first chunk.
  Attempts attempts_;
  std::optional<StreamCall<v1::SweepResponse>> call_;
  v1::SweepResponse message_;
};

}  // namespace ricochet

#endif  // RICOCHET_CLIENT_SWEEP_READER_H_
