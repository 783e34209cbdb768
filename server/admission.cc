#include "server/admission.h"

#include <chrono>

#include "absl/strings/str_cat.h"
#include "ricochet/error.h"

namespace ricochet::server {

absl::StatusOr<Admission::Ticket> Admission::Enter() {
  if (++live_ <= limit_) return Ticket(live_);
  --live_;
  absl::Status refusal =
      MakeError(absl::StatusCode::kResourceExhausted, ErrorReason::kTooManyCalls,
                absl::StrCat("the server is at its limit of ", limit_, " live calls; try again later"));
  SetRetryDelay(std::chrono::seconds(1), refusal);
  return refusal;
}

}  // namespace ricochet::server
