#include "core/engine/call_control.h"

namespace ricochet {
namespace {

constexpr std::chrono::milliseconds kBetweenLooks(1);

}  // namespace

absl::Status CallControl::WhyEnded() const {
  if (options_.deadline.has_value() && Clock::now() >= *options_.deadline) {
    return absl::DeadlineExceededError("the call's deadline has passed");
  }
  if (options_.stop.stop_requested() || (options_.is_stopped != nullptr && options_.is_stopped())) {
    return absl::CancelledError("the call was stopped by its caller");
  }
  return absl::OkStatus();
}

absl::Status CallControl::OrWhyEnded(const absl::Status& error) const {
  if (!absl::IsCancelled(error)) return error;
  const absl::Status ended = WhyEnded();
  return ended.ok() ? error : ended;
}

bool CallControl::IsStopped() {
  if (is_stopped_) return true;
  now_ = Clock::now();
  if (now_ < next_look_) return false;
  next_look_ = now_ + kBetweenLooks;
  is_stopped_ = !WhyEnded().ok();
  return is_stopped_;
}

void CallControl::StartPiece(std::chrono::milliseconds time) {
  now_ = Clock::now();
  piece_end_ = now_ + time;
  next_look_ = now_;
}

}  // namespace ricochet
