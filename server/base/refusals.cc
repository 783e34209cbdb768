#include "server/base/refusals.h"

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <string>

#include "absl/strings/str_cat.h"
#include "ricochet/error.h"

namespace ricochet::server {
namespace {

using std::chrono::milliseconds;

absl::Status Refusal(absl::StatusCode code, ErrorReason reason, const std::string& message, milliseconds retry_delay) {
  absl::Status refusal = MakeError(code, reason, message);
  SetRetryDelay(retry_delay, refusal);
  return refusal;
}

absl::Status NoRoom(const std::string& message) {
  return Refusal(absl::StatusCode::kResourceExhausted, ErrorReason::kTooManyCalls, message, milliseconds(1000));
}

}  // namespace

absl::Status TooManyCalls(const std::string& what, int limit) {
  return NoRoom(absl::StrCat("the server is at its limit of ", limit, " ", what, "; try again later"));
}

absl::Status TooManyCallsOfPeer(const std::string& what, int limit) {
  return NoRoom(absl::StrCat("this client is at its limit of ", limit, " ", what, "; try again later"));
}

absl::Status NoMemory(int64_t limit) {
  return NoRoom(absl::StrCat("the requests and answers of all calls hold the ", limit >> 20,
                             " MiB that the server has for them; try again later"));
}

absl::Status NoMemoryOfPeer(int64_t limit) {
  return NoRoom(absl::StrCat("the requests and answers of this client's calls hold ", limit >> 20,
                             " MiB, its limit; read the answers, and try again later"));
}

absl::Status NoThread() { return NoRoom("the server has no thread for another call; try again later"); }

static milliseconds RetryAfter(std::chrono::duration<double> wait) {
  return std::clamp(std::chrono::duration_cast<milliseconds>(wait), milliseconds(100), milliseconds(5000));
}

absl::Status Overloaded(std::chrono::duration<double> wait) {
  return Refusal(absl::StatusCode::kResourceExhausted, ErrorReason::kOverloaded,
                 "more work waits to be computed than would let this call end in time; try again later",
                 RetryAfter(wait));
}

absl::Status QueueFull(size_t most, std::chrono::duration<double> wait) {
  return Refusal(absl::StatusCode::kResourceExhausted, ErrorReason::kOverloaded,
                 absl::StrCat(most, " calls, the most that may, wait to be computed; try again later"),
                 RetryAfter(wait));
}

absl::Status TimeLimitReached(milliseconds limit) {
  return MakeError(absl::StatusCode::kDeadlineExceeded, ErrorReason::kTimeLimit,
                   absl::StrCat("the call took longer than ", limit.count(), " ms, the server's limit of one call"));
}

absl::Status AgeLimitReached(milliseconds limit) {
  return Refusal(absl::StatusCode::kUnavailable, ErrorReason::kAgeLimit,
                 absl::StrCat("the stream has run for ", limit.count(),
                              " ms, the server's limit; ask again, a sweep from the first point not received"),
                 milliseconds(0));
}

absl::Status UnreadLimitReached(milliseconds limit) {
  return MakeError(absl::StatusCode::kCancelled, ErrorReason::kUnreadLimit,
                   absl::StrCat("the caller did not read one message in ", limit.count(), " ms, the server's limit"));
}

absl::Status PauseLimitReached(milliseconds limit) {
  return MakeError(absl::StatusCode::kCancelled, ErrorReason::kUnreadLimit,
                   absl::StrCat("the caller sent no batch in ", limit.count(), " ms, the server's limit"));
}

absl::Status CallerRemoved() {
  return absl::UnauthenticatedError("the caller is no longer known or may no longer make this call, which ends here");
}

absl::Status Draining() {
  return Refusal(absl::StatusCode::kUnavailable, ErrorReason::kDraining,
                 "the server is shutting down; ask again, a sweep from the first point not received",
                 milliseconds(1000));
}

}  // namespace ricochet::server
