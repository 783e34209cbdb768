#include "server/refusals.h"

#include <chrono>
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

}  // namespace

absl::Status TooManyCalls(int limit) {
  return Refusal(absl::StatusCode::kResourceExhausted, ErrorReason::kTooManyCalls,
                 absl::StrCat("the server is at its limit of ", limit, " live calls; try again later"),
                 milliseconds(1000));
}

absl::Status Draining() {
  return Refusal(absl::StatusCode::kUnavailable, ErrorReason::kDraining,
                 "the server is shutting down; ask again, a sweep from the first point not received",
                 milliseconds(1000));
}

}  // namespace ricochet::server
