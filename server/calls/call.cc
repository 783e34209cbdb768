#include "server/calls/call.h"

#include <algorithm>
#include <memory>
#include <stop_token>
#include <string>
#include <utility>

#include "proto/wire/status.h"
#include "ricochet/error.h"
#include "server/base/refusals.h"
#include "server/base/request_id.h"
#include "server/base/telemetry_names.h"
#include "server/security/auth.h"
#include "server/security/peer.h"

namespace ricochet::server {
namespace {

// Asking gRPC whether a call is cancelled can take 10 us or more, because it polls, so that it is asked only this often
// while the call goes on.
constexpr std::chrono::milliseconds kBetweenLooks(1);

// A stream can run for an hour. This often it looks whether its caller is still known.
constexpr std::chrono::seconds kBetweenChecks(1);

// A write that takes longer than this is counted as a stall.
constexpr std::chrono::seconds kStall(1);

bool HasExpired(const grpc::ServerContext& context) { return context.deadline() <= std::chrono::system_clock::now(); }

// Ending is the end of a call, once gRPC has sent the answer: gRPC then knows without polling whether the caller gave
// up, and nobody waits for the record.
class Ending {
 public:
  Ending(LiveCalls::Permit place, CallMemory::Hold answer, CallRecord record, grpc::ServerContext& context,
         const Observer& observer)
      : place_(std::move(place)),
        answer_(std::move(answer)),
        record_(std::move(record)),
        context_(context),
        observer_(observer) {}
  ~Ending() {
    if (record_.status != absl::StatusCode::kDeadlineExceeded && context_.IsCancelled()) {
      record_.status = HasExpired(context_) ? absl::StatusCode::kDeadlineExceeded : absl::StatusCode::kCancelled;
    }
    answer_.reset();
    place_.reset();
    observer_.Ended(record_);
  }
  Ending(const Ending&) = delete;
  Ending& operator=(const Ending&) = delete;

 private:
  LiveCalls::Permit place_;
  CallMemory::Hold answer_;
  CallRecord record_;
  grpc::ServerContext& context_;
  const Observer& observer_;
};

}  // namespace

Call::Call(const char* method, Kind kind, grpc::ServerContext& context, const CallFrame& frame)
    : kind_(kind),
      context_(context),
      frame_(frame),
      peer_key_(PeerKey(context, frame.auth)),
      next_look_(start_ + kBetweenLooks),
      next_check_(start_ + kBetweenChecks),
      place_(frame.live_calls.Enter(peer_key_, kind == Kind::kStream)),
      record_(RecordOf(method, context)) {
  // Trailing metadata, because a client repeats only a call that was refused without initial metadata.
  context.AddTrailingMetadata(kRequestIdHeader, record_.request_id);
}

Call::~Call() {
  record_.duration_s = elapsed_s();
  LiveCalls::Permit place;
  if (place_.ok()) place = *std::move(place_);
  const bool is_refused = place == nullptr;
  frame_.unread.Sends(
      context_, is_refused,
      std::make_shared<Ending>(std::move(place), std::move(answer_), std::move(record_), context_, frame_.observer));
}

absl::Status Call::admitted() const {
  if (frame_.drain.streams.stop_requested()) return Draining();
  return place_.status();
}

double Call::elapsed_s() const {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
}

CallOptions Call::options() const {
  using std::chrono::system_clock;
  CallOptions options = {.stop = drain(),
                         .deadline = start_ + time_limit(),
                         .is_stopped = [this] { return IsCancelled(); },
                         .helpers = frame_.scheduler.HelpersFor(peer_key_)};
  const system_clock::time_point deadline = context_.deadline();
  if (deadline != system_clock::time_point::max()) {
    const auto left = deadline - system_clock::now();
    options.deadline = std::min(*options.deadline, std::chrono::steady_clock::now() + left);
  }
  return options;
}

absl::Status Call::CheckCaller() {
  const auto now = std::chrono::steady_clock::now();
  if (frame_.auth == nullptr || now < next_check_) return absl::OkStatus();
  next_check_ = now + kBetweenChecks;
  return frame_.auth->StillAllows(context_, PathOf(record_.method), peer_key_) ? absl::OkStatus() : CallerRemoved();
}

absl::Status Call::Compute(std::optional<RequestCost> cost, absl::FunctionRef<absl::Status()> work) {
  if (absl::Status removed = CheckCaller(); !removed.ok()) return removed;
  const CallOptions limits = options();
  const double asked_s = elapsed_s();
  const ComputeRequest request = {
      .peer = peer_key_, .deadline = limits.deadline, .is_gone = limits.is_stopped, .cost = cost};
  std::optional<absl::Status> done;
  absl::Status computed = frame_.scheduler.Compute(request, [&] {
    record_.queued_s += elapsed_s() - asked_s;
    done = work();
  });
  if (done.has_value()) return *std::move(done);
  record_.queued_s += elapsed_s() - asked_s;
  return computed;
}

absl::StatusOr<bool> Call::Receive(absl::FunctionRef<bool()> read) {
  const UnreadWatch::Write watched(frame_.unread, context_);
  // A read cannot be ended but by ending the call.
  const std::stop_callback drained(drain(), [this] { context_.TryCancel(); });
  if (read()) return true;
  if (watched.is_cut()) return PauseLimitReached(frame_.unread.limit());
  if (context_.IsCancelled()) return absl::CancelledError("the client cancelled the call or went away");
  return false;
}

absl::Status Call::HoldAnswer(int64_t bytes) {
  answer_.reset();
  absl::StatusOr<CallMemory::Hold> taken = frame_.memory.Take([this] { return peer_key_; }, bytes);
  if (!taken.ok()) return taken.status();
  answer_ = *std::move(taken);
  return absl::OkStatus();
}

absl::Status Call::Send(absl::FunctionRef<bool()> write) {
  const UnreadWatch::Write watched(frame_.unread, context_);
  const bool is_written = write();
  answer_.reset();
  if (watched.waited() > kStall) {
    ++record_.stalls;
    record_.stalled_s += watched.waited().count();
  }
  // A write that was already on its way when the watch cancelled the call can still succeed.
  if (watched.is_cut()) return UnreadLimitReached(frame_.unread.limit());
  if (is_written) return absl::OkStatus();
  return absl::CancelledError("the client cancelled the call or went away");
}

grpc::Status Call::Finish(const absl::Status& status) {
  const absl::Status explained = Explained(status);
  record_.status = HasExpired(context_) ? absl::StatusCode::kDeadlineExceeded : explained.code();
  record_.reason = ReasonName(ReasonOf(explained));
  record_.message = std::string(explained.message());
  return ToGrpcStatus(explained);
}

std::chrono::milliseconds Call::time_limit() const {
  return kind_ == Kind::kUnary ? frame_.limits.unary_time : frame_.limits.stream_age;
}

const std::stop_token& Call::drain() const { return kind_ == Kind::kUnary ? frame_.drain.unary : frame_.drain.streams; }

bool Call::IsCancelled() const {
  const auto now = std::chrono::steady_clock::now();
  if (is_cancelled_ || now < next_look_) return is_cancelled_;
  next_look_ = now + kBetweenLooks;
  is_cancelled_ = context_.IsCancelled();
  return is_cancelled_;
}

absl::Status Call::Explained(const absl::Status& status) const {
  if (absl::IsCancelled(status) && drain().stop_requested() && !context_.IsCancelled()) return Draining();
  const bool is_by_client = HasExpired(context_);
  const bool is_by_server = elapsed_s() >= std::chrono::duration<double>(time_limit()).count();
  if (!absl::IsDeadlineExceeded(status) || is_by_client || !is_by_server) return status;
  return kind_ == Kind::kUnary ? TimeLimitReached(time_limit()) : AgeLimitReached(time_limit());
}

}  // namespace ricochet::server
