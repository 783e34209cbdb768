#include "client/sweep_fan_out.h"

#include <algorithm>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "client/call_context.h"
#include "client/chunk_checker.h"
#include "client/stream_call.h"
#include "core/base/try.h"
#include "proto/wire/status.h"
#include "proto/wire/sweep.h"
#include "ricochet/error.h"

namespace ricochet {
namespace {

using std::chrono::milliseconds;

// A range should take a server this long: long beside the time of a call, short beside that of a sweep that is worth
// sharing. Towards the end ranges are shorter, so that all servers end together, but not below the shortest time.
constexpr double kRangeSeconds = 1.0;
constexpr double kShortestSeconds = 0.03;
// Nothing is known of a server before its first range, which has one point; the next ones grow at most by this factor.
constexpr double kMostGrowth = 8.0;
// If only a function of the caller can tell whether to stop, it is asked this often.
constexpr milliseconds kLook{20};

int64_t PointBytes(const SweepRequest& request) {
  const auto columns = std::max<int64_t>(1, static_cast<int64_t>(request.columns.size()));
  // The regime and the status are a byte each.
  return columns * static_cast<int64_t>(sizeof(double)) + (request.with_regime ? 2 : 0);
}

// Returns the status with another message and all that it carries.
absl::Status WithMessage(const absl::Status& from, const std::string& message) {
  absl::Status status(from.code(), message);
  CopyPayloads(from, status);
  return status;
}

SweepRequest Part(SweepRequest request, const RangeScheduler::Task& task) {
  request.first_index = task.first_index;
  request.end_index = task.end_index;
  return request;
}

}  // namespace

// Server holds what the thread of a server knows about it.
class SweepFanOut::Server {
 public:
  Server(size_t number, const RetryPolicy& policy) : number_(number), attempts_(alone_, policy) {}

  size_t number() const { return number_; }
  Attempts& attempts() { return attempts_; }

  // The length of the next range, if `unclaimed` points are left for `servers` servers.
  int64_t NextLength(int64_t unclaimed, size_t servers) const {
    const double share = static_cast<double>(unclaimed) / (2.0 * static_cast<double>(servers));
    const double most = std::min(rate_ * kRangeSeconds, last_ * kMostGrowth);
    const double length = std::max(std::min(most, share), std::min(most, rate_ * kShortestSeconds));
    return std::max<int64_t>(1, static_cast<int64_t>(length));
  }

  void Computed(int64_t points, std::chrono::duration<double> time) {
    last_ = static_cast<double>(points);
    rate_ = last_ / std::max(time.count(), 1e-6);
    slow_ = 0;
  }

  // Returns how long a server that was too slow is left alone, which is twice as long each time.
  milliseconds AfterSlow(milliseconds slow_after) {
    constexpr int kMostDoublings = 10;
    return slow_after * (1 << std::min(slow_++, kMostDoublings));
  }

 private:
  const size_t number_;
  PreferredServer alone_{1};
  Attempts attempts_;
  double last_ = 0.0;  // Points of the last range.
  double rate_ = 0.0;  // Points a second in it.
  int slow_ = 0;       // How often in a row it was too slow.
};

SweepFanOut::SweepFanOut(const SweepRequest& request, Servers servers, CallOptions options)
    : request_(request),
      servers_(std::move(servers)),
      options_(std::move(options)),
      scheduler_(request.first_index, *request.end_index, PointBytes(request), servers_.fan_out.buffer_bytes,
                 static_cast<int64_t>(servers_.count)),
      is_lost_(servers_.count) {
  StartThreads();
  on_stop_.emplace(options_.stop, [this] { End(); });
}

SweepFanOut::~SweepFanOut() {
  on_stop_.reset();
  End();
  for (std::thread& thread : threads_) thread.join();
}

void SweepFanOut::StartThreads() {
  try {
    for (size_t number = 0; number < servers_.count; ++number) {
      threads_.emplace_back([this, number] { Serve(number); });
    }
  } catch (const std::system_error&) {
    const std::lock_guard lock(mutex_);
    // The servers that have a thread can do all the work.
    if (threads_.empty()) {
      failure_ = absl::ResourceExhaustedError("the system gives no thread for a server of the sweep");
    }
    for (size_t number = threads_.size(); number < servers_.count; ++number) is_lost_[number] = true;
  }
}

void SweepFanOut::End() {
  const std::lock_guard lock(mutex_);
  ended_ = true;
  scheduler_.StopAll();
  arrived_.notify_all();
  work_.notify_all();
}

int64_t SweepFanOut::most_waiting_bytes() const {
  const std::lock_guard lock(mutex_);
  return scheduler_.most_waiting_bytes();
}

void SweepFanOut::Serve(size_t number) {
  Server server(number, servers_.retry);
  while (const std::optional<RangeScheduler::Task> task = WaitForTask(server)) {
    const Clock::time_point start = Clock::now();
    const absl::Status status = Compute(*task, server);
    {
      const std::lock_guard lock(mutex_);
      scheduler_.End(*task);
      work_.notify_all();
    }
    if (status.ok()) {
      server.Computed(task->end_index - task->first_index, Clock::now() - start);
    } else {
      Fail(status, *task, server);
    }
  }
}

std::optional<RangeScheduler::Task> SweepFanOut::WaitForTask(const Server& server) {
  std::unique_lock lock(mutex_);
  for (;;) {
    if (ended_ || failure_.has_value()) return std::nullopt;
    std::optional<RangeScheduler::Task> task =
        scheduler_.Claim(server.NextLength(scheduler_.unclaimed(), servers_.count));
    if (task.has_value()) return task;
    work_.wait(lock);
  }
}

absl::Status SweepFanOut::Compute(const RangeScheduler::Task& task, Server& server) {
  const SweepRequest part = Part(request_, task);
  const v1::SweepRequest wire = ToProto(part);
  ChunkChecker checker(part);
  StreamCall<v1::SweepResponse> call(
      [&](grpc::ClientContext* context) { return servers_.start(server.number(), context, wire); }, std::nullopt,
      {.stop = task.stop.get_token(), .deadline = options_.deadline});
  v1::SweepResponse message;
  while (call.Read(message)) {
    RICOCHET_TRY(SweepChunk chunk, checker.Accept(message));
    server.attempts().Succeeded();
    const std::lock_guard lock(mutex_);
    if (!scheduler_.Put(task, std::move(chunk))) break;
    has_begun_ = true;
    is_lost_[server.number()] = false;
    arrived_.notify_one();
  }
  const absl::Status status = task.stop.stop_requested() ? call.Cancel() : call.Finish();
  const absl::Status complete = checker.CheckEnd();
  // A call that fails after its last chunk has already delivered everything.
  return complete.ok() || status.ok() ? complete : status;
}

void SweepFanOut::Fail(const absl::Status& status, const RangeScheduler::Task& task, Server& server) {
  if (task.stop.stop_requested()) {
    // Another server was faster. If it was asked after this one, then this one was slow.
    if (!task.is_second) BackOff(server.AfterSlow(servers_.fan_out.slow_after));
    return;
  }
  std::optional<milliseconds> wait;
  {
    const std::lock_guard lock(mutex_);
    const bool may_resume = MayResume(status);
    if (!failure_.has_value() && !may_resume && !IsOwnRefusal(status)) failure_ = FromServer(status, server.number());
    if (may_resume) {
      wait = server.attempts().AfterFailure(status,
                                            has_begun_ ? servers_.retry.max_resumes : servers_.retry.max_attempts - 1);
    }
    is_lost_[server.number()] = !wait.has_value();
    const bool all_lost = std::all_of(is_lost_.begin(), is_lost_.end(), [](bool is_lost) { return is_lost; });
    if (!failure_.has_value() && all_lost) {
      failure_ = may_resume ? NoServerLeft(status) : FromServer(status, server.number());
    }
    if (failure_.has_value()) {
      scheduler_.StopAll();
      arrived_.notify_all();
      work_.notify_all();
    }
  }
  BackOff(wait.value_or(std::max(servers_.retry.max_backoff, RetryDelayOf(status).value_or(milliseconds(0)))));
}

void SweepFanOut::BackOff(milliseconds time) {
  std::unique_lock lock(mutex_);
  // A server may ask for a delay of any length.
  work_.wait_until(lock, Clock::now() + std::min(time, kLongestTime),
                   [this] { return ended_ || failure_.has_value(); });
}

absl::Status SweepFanOut::FromServer(const absl::Status& status, size_t number) const {
  // Every server finds the same faults in a request, so that it does not matter which one tells them.
  if (absl::IsInvalidArgument(status)) return status;
  const std::string name = absl::StrCat("server ", number + 1, " of ", servers_.count);
  std::vector<Violation> violations = ViolationsOf(status);
  if (violations.empty()) return WithMessage(status, absl::StrCat(name, ": ", status.message()));
  for (Violation& violation : violations) absl::StrAppend(&violation.description, " (", name, ")");
  return WithViolations(status, violations);
}

absl::Status SweepFanOut::NoServerLeft(const absl::Status& last) const {
  return WithMessage(last, absl::StrCat("none of the ", servers_.count, " servers goes on with the sweep at point ",
                                        scheduler_.next_index(), "; the last error: ", last.message()));
}

std::optional<absl::StatusOr<SweepChunk>> SweepFanOut::Next() {
  const milliseconds slow_after = servers_.fan_out.slow_after;
  Clock::time_point slow_at = Clock::now() + slow_after;
  for (;;) {
    if (points_ == *request_.end_index - request_.first_index) return std::nullopt;
    if (IsStopped(options_)) return StoppedByCaller();
    const Clock::time_point now = Clock::now();
    Clock::time_point until = std::min(slow_at, options_.deadline.value_or(slow_at));
    if (options_.is_stopped != nullptr) until = std::min(until, now + kLook);
    if (auto next = WaitUntil(until); next.has_value()) return next;
    if (options_.deadline.has_value() && now >= *options_.deadline) {
      return absl::DeadlineExceededError("the deadline of the sweep has passed");
    }
    if (now < slow_at) continue;
    const std::lock_guard lock(mutex_);
    scheduler_.AskAnother();
    work_.notify_all();
    slow_at = now + slow_after;
  }
}

std::optional<absl::StatusOr<SweepChunk>> SweepFanOut::WaitUntil(Clock::time_point until) {
  std::unique_lock lock(mutex_);
  std::optional<RangeScheduler::Piece> piece;
  arrived_.wait_until(lock, until, [&] {
    piece = scheduler_.Emit();
    return piece.has_value() || failure_.has_value() || ended_;
  });
  if (!piece.has_value()) {
    if (failure_.has_value()) return absl::StatusOr<SweepChunk>(*failure_);
    return std::nullopt;
  }
  work_.notify_all();
  lock.unlock();
  return Join(*std::move(piece));
}

absl::StatusOr<SweepChunk> SweepFanOut::Join(RangeScheduler::Piece piece) {
  SweepChunk& chunk = piece.chunk;
  if (task_ != 0 && chunk.engine.fingerprint != engine_) {
    return OtherEngine(chunk.first_index, chunk.engine.fingerprint, engine_);
  }
  engine_ = chunk.engine.fingerprint;
  if (piece.task != task_) other_tallies_ = Joined(other_tallies_, std::exchange(task_tallies_, {}));
  task_ = piece.task;
  task_tallies_ = chunk.tallies;
  points_ += chunk.count;
  chunk.tallies = Joined(other_tallies_, task_tallies_);
  chunk.points_done = points_;
  chunk.points_total = *request_.end_index - request_.first_index;
  // The summaries of the ranges are not that of the sweep.
  chunk.summary.reset();
  if (points_ == chunk.points_total) chunk.summary = chunk.tallies;
  return std::move(chunk);
}

}  // namespace ricochet
