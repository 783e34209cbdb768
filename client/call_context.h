// CallContext: the gRPC context of a call that ends when its CallOptions say so.

#ifndef RICOCHET_CLIENT_CALL_CONTEXT_H_
#define RICOCHET_CLIENT_CALL_CONTEXT_H_

#include <grpcpp/client_context.h>

#include <algorithm>
#include <chrono>
#include <functional>
#include <optional>
#include <stop_token>

#include "absl/status/status.h"
#include "ricochet/call_options.h"

namespace ricochet {

// Returns true if the caller has asked to end the call.
inline bool IsStopped(const CallOptions& options) {
  return options.stop.stop_requested() || (options.is_stopped != nullptr && options.is_stopped());
}

inline absl::Status StoppedByCaller() { return absl::CancelledError("the call was stopped by its caller"); }

// The longest time that a call or a wait can be given, so that no clock overflows.
inline constexpr std::chrono::milliseconds kLongestTime = std::chrono::hours(24 * 365);

// Thread safety: the stop token may be triggered from any thread; everything else is for one thread at a time.
class CallContext {
 public:
  // The call ends at the deadline of `options`, or `most` from now if that is earlier; absent: no limit.
  CallContext(const CallOptions& options, std::optional<std::chrono::milliseconds> most)
      : cancel_(options.stop, [this] { context_.TryCancel(); }) {
    std::optional<std::chrono::nanoseconds> left = most;
    if (options.deadline.has_value()) {
      // The difference to a time long past would overflow.
      const auto now = std::chrono::steady_clock::now();
      const std::chrono::nanoseconds given = std::max(*options.deadline, now - kLongestTime) - now;
      left = std::min(given, left.value_or(given));
    }
    if (IsStopped(options)) context_.TryCancel();
    // gRPC takes a time of the system's clock.
    if (left.has_value()) {
      context_.set_deadline(std::chrono::system_clock::now() + std::min<std::chrono::nanoseconds>(*left, kLongestTime));
    }
  }

  grpc::ClientContext& get() { return context_; }

 private:
  grpc::ClientContext context_;
  // The callback is the last member, so that it is destroyed before the context that it cancels.
  std::stop_callback<std::function<void()>> cancel_;
};

}  // namespace ricochet

#endif  // RICOCHET_CLIENT_CALL_CONTEXT_H_
