// Attempts: on which server, and after which time, a call that failed is tried again.

#ifndef RICOCHET_CLIENT_ATTEMPTS_H_
#define RICOCHET_CLIENT_ATTEMPTS_H_

#include <atomic>
#include <chrono>
#include <cstddef>
#include <optional>
#include <vector>

#include "absl/random/random.h"
#include "absl/status/status.h"
#include "ricochet/call_options.h"
#include "ricochet/client_options.h"

namespace ricochet {

// The server at which new calls start: the first of the list that no call has had to leave, then round the list.
// Thread safety: any number of threads may use it.
class PreferredServer {
 public:
  explicit PreferredServer(size_t servers) : servers_(servers) {}

  size_t count() const { return servers_; }
  size_t get() const { return number_.load(std::memory_order_relaxed); }
  // Returns the server after `failed`, where new calls now start unless another call has already moved them on.
  size_t MoveOn(size_t failed);

 private:
  size_t servers_;
  std::atomic<size_t> number_ = 0;
};

// The attempts of one call. Thread safety: one thread.
class Attempts {
 public:
  Attempts(PreferredServer& preferred, const RetryPolicy& policy);

  // The server of the next attempt.
  size_t server() const { return server_; }

  // Chooses the server after one that failed with `status`, and returns the time to wait before asking it: a random one
  // that grows from failure to failure, and at least what that server has asked for (google.rpc.RetryInfo). Nothing if
  // `most` attempts in a row have failed before, or if a server asks for more than a minute.
  std::optional<std::chrono::milliseconds> AfterFailure(const absl::Status& status, int most);

  // Starts the count and the waits anew, after a success.
  void Succeeded();

 private:
  using Clock = std::chrono::steady_clock;

  PreferredServer& preferred_;
  const RetryPolicy policy_;
  size_t server_;
  std::vector<Clock::time_point> not_before_;  // One for each server.
  int failures_ = 0;
  double limit_ms_;  // The next random wait is at most this.
  absl::BitGen random_;
};

// True if the server refused a call for now, and said when to repeat it.
bool IsWorthRepeating(const absl::Status& status);

// True if another call may get further than a stream that ended with `status`. Proxies report a dead server as UNKNOWN
// or INTERNAL, and a server that drains may cancel a call that it has not read yet.
bool MayResume(const absl::Status& status);

// True if the server refused a call for a reason of its own, such as its limits or its list of callers, so that another
// one may answer it.
bool IsOwnRefusal(const absl::Status& status);

// Gives all attempts of a call one deadline, at most `most` from now; absent: that of the options, if any.
CallOptions WithDeadline(CallOptions options, std::optional<std::chrono::milliseconds> most);

// Waits. Returns false, at once or within 20 ms, if the options end the call before the time is over.
bool Pause(std::chrono::milliseconds time, const CallOptions& options);

}  // namespace ricochet

#endif  // RICOCHET_CLIENT_ATTEMPTS_H_
