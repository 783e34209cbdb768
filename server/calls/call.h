// Call: the frame around the work of every handler. It takes a place among the live calls, has the work done at the
// scheduler, ends the call at the server's limits, gathers what is known of the call and hands it to the observer at
// the end.

#ifndef RICOCHET_SERVER_CALLS_CALL_H_
#define RICOCHET_SERVER_CALLS_CALL_H_

#include <grpcpp/server_context.h>
#include <grpcpp/support/status.h>

#include <chrono>
#include <optional>
#include <string>

#include "absl/functional/function_ref.h"
#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "ricochet/call_options.h"
#include "server/admission/call_memory.h"
#include "server/admission/live_calls.h"
#include "server/admission/scheduler.h"
#include "server/admission/unread_watch.h"
#include "server/base/drain.h"
#include "server/telemetry/call_record.h"
#include "server/telemetry/observer.h"

namespace ricochet::server {

// Says how long a call may run, whatever its client allows; both > 0.
struct TimeLimits {
  std::chrono::milliseconds unary_time{60'000};
  std::chrono::milliseconds stream_age{3'600'000};
  friend bool operator==(const TimeLimits&, const TimeLimits&) = default;
};

class Auth;

// CallFrame: the objects that all calls of a server share.
struct CallFrame {
  LiveCalls& live_calls;
  CallMemory& memory;
  Scheduler& scheduler;
  UnreadWatch& unread;
  DrainStops drain;
  TimeLimits limits;
  const Observer& observer;
  Auth* auth = nullptr;  // Knows callers by token or certificate; null if the server has no such list.
};

class Call {
 public:
  enum class Kind { kUnary, kStream };

  // Starts the clock, takes a place and adds the request id to the metadata of the answer. `method` is the method's
  // name without that of the service. All arguments by reference must outlive the call.
  Call(const char* method, Kind kind, grpc::ServerContext& context, const CallFrame& frame);
  // Gives the place back and hands the record to the observer, as soon as the answer is sent.
  ~Call();
  Call(const Call&) = delete;
  Call& operator=(const Call&) = delete;

  // OK, or the error with which the handler must finish at once.
  absl::Status admitted() const;

  // Returns the seconds since the start.
  double elapsed_s() const;

  // Returns the options of the solver's call. It ends at the client's deadline, at the server's limit of time, when the
  // client cancels or vanishes, and when the drain asks for it. This object must outlive them.
  CallOptions options() const;

  // Does the work when it is this call's turn, and returns what it returns; or returns the error for which it was not
  // done, one of which is that the caller is no longer known. `cost` is absent for a part of a stream.
  absl::Status Compute(std::optional<RequestCost> cost, absl::FunctionRef<absl::Status()> work);

  // Waits for the next message of the caller by `read`, which returns false if there is none. Returns what `read` does.
  // Errors: CANCELLED if the caller has ended the call, if it has sent nothing for as long as it may leave an answer
  // unread, or if the drain has begun.
  absl::StatusOr<bool> Receive(absl::FunctionRef<bool()> read);

  // Takes memory for an answer of so many bytes, until the answer is sent, or for one message of a stream, until Send
  // returns. Errors: those of CallMemory::Take.
  absl::Status HoldAnswer(int64_t bytes);

  // Sends one message of a stream by `write`, which returns false if the call has ended.
  absl::Status Send(absl::FunctionRef<bool()> write);

  // Handlers add to it what they learn of the call: points, chunks, models.
  CallRecord& record() { return record_; }

  // Records the status and returns what the handler must return. Replaces the error of a call that the drain or a limit
  // of time has ended by one that says so.
  grpc::Status Finish(const absl::Status& status);

 private:
  std::chrono::milliseconds time_limit() const;
  const std::stop_token& drain() const;
  // True once the caller has cancelled the call or went away, but a millisecond late at most. One thread at a time.
  bool IsCancelled() const;
  // Looks from time to time whether the caller is still known and may make the call. Returns UNAUTHENTICATED if not.
  absl::Status CheckCaller();
  absl::Status Explained(const absl::Status& status) const;

  const std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  const Kind kind_;
  grpc::ServerContext& context_;
  const CallFrame& frame_;
  const std::string peer_key_;
  mutable std::chrono::steady_clock::time_point next_look_;
  mutable bool is_cancelled_ = false;
  std::chrono::steady_clock::time_point next_check_;
  absl::StatusOr<LiveCalls::Permit> place_;
  CallMemory::Hold answer_;
  // The status UNKNOWN stays if a handler throws and never finishes; gRPC then answers the same.
  CallRecord record_;
};

}  // namespace ricochet::server

#endif  // RICOCHET_SERVER_CALLS_CALL_H_
