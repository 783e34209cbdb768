#include "server/admission.h"

#include "server/refusals.h"

namespace ricochet::server {

absl::StatusOr<Admission::Ticket> Admission::Enter() {
  if (++live_ <= limit_) return Ticket(live_);
  --live_;
  return TooManyCalls(limit_);
}

}  // namespace ricochet::server
