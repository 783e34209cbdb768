#include "client/attempts.h"

#include <algorithm>
#include <thread>

#include "client/call_context.h"
#include "ricochet/error.h"

namespace ricochet {
namespace {

using std::chrono::milliseconds;
using Deadline = std::chrono::steady_clock::time_point;

// A longer wait is left to the program, which gets the error instead.
constexpr milliseconds kLongestWait = std::chrono::minutes(1);
constexpr milliseconds kLook{20};

}  // namespace

size_t PreferredServer::MoveOn(size_t failed) {
  const size_t next = (failed + 1) % servers_;
  number_.compare_exchange_strong(failed, next, std::memory_order_relaxed);
  return next;
}

Attempts::Attempts(PreferredServer& preferred, const RetryPolicy& policy)
    : preferred_(preferred), policy_(policy), server_(preferred.get()), not_before_(preferred.count()) {
  Succeeded();
}

std::optional<milliseconds> Attempts::AfterFailure(const absl::Status& status, int most) {
  if (failures_ >= most) return std::nullopt;
  ++failures_;
  const milliseconds asked_for = RetryDelayOf(status).value_or(milliseconds(0));
  if (asked_for > kLongestWait) return std::nullopt;
  const Clock::time_point now = Clock::now();
  not_before_[server_] = now + asked_for;
  server_ = preferred_.MoveOn(server_);
  const milliseconds at_random(static_cast<int64_t>(absl::Uniform(absl::IntervalClosed, random_, 0.0, limit_ms_)));
  limit_ms_ = std::min(limit_ms_ * policy_.multiplier, static_cast<double>(policy_.max_backoff.count()));
  return std::max(at_random, std::chrono::ceil<milliseconds>(not_before_[server_] - now));
}

void Attempts::Succeeded() {
  failures_ = 0;
  limit_ms_ = static_cast<double>(policy_.initial_backoff.count());
}

bool IsWorthRepeating(const absl::Status& status) {
  return absl::IsResourceExhausted(status) && RetryDelayOf(status).has_value();
}

bool MayResume(const absl::Status& status) {
  switch (status.code()) {
    case absl::StatusCode::kUnavailable:
    case absl::StatusCode::kUnknown:
    case absl::StatusCode::kInternal:
    case absl::StatusCode::kCancelled:
      return true;
    case absl::StatusCode::kResourceExhausted:
      return IsWorthRepeating(status);
    default:
      return false;
  }
}

bool IsOwnRefusal(const absl::Status& status) {
  return absl::IsResourceExhausted(status) || absl::IsUnauthenticated(status) || absl::IsPermissionDenied(status) ||
         absl::IsUnimplemented(status);
}

CallOptions WithDeadline(CallOptions options, std::optional<milliseconds> most) {
  if (!most.has_value()) return options;
  const Deadline end = std::chrono::steady_clock::now() + std::min(*most, kLongestTime);
  options.deadline = std::min(end, options.deadline.value_or(end));
  return options;
}

bool Pause(milliseconds time, const CallOptions& options) {
  const auto end = std::chrono::steady_clock::now() + time;
  if (options.deadline.has_value() && end >= *options.deadline) return false;
  for (auto now = std::chrono::steady_clock::now(); now < end; now = std::chrono::steady_clock::now()) {
    if (IsStopped(options)) return false;
    std::this_thread::sleep_for(std::min<std::chrono::nanoseconds>(end - now, kLook));
  }
  return !IsStopped(options);
}

}  // namespace ricochet
