// StopCheck: asks the caller now and then whether the computation has to stop.

#ifndef RICOCHET_CORE_MODELS_FINITE_DURATION_STOP_CHECK_H_
#define RICOCHET_CORE_MODELS_FINITE_DURATION_STOP_CHECK_H_

#include "absl/functional/function_ref.h"

namespace ricochet::finite_duration {

class StopCheck {
 public:
  explicit StopCheck(absl::FunctionRef<bool()> stopped) : stopped_(stopped) {}

  // Call it before each step of the integration and each sample of a history; both take some ten microseconds. The
  // caller is asked before the first of every kPieces.
  bool IsStopped() {
    if (piece_ == 0 && !is_stopped_) is_stopped_ = stopped_();
    piece_ = (piece_ + 1) % kPieces;
    return is_stopped_;
  }

  // Tells the last answer.
  bool WasStopped() const { return is_stopped_; }

 private:
  static constexpr int kPieces = 4;

  absl::FunctionRef<bool()> stopped_;
  bool is_stopped_ = false;
  int piece_ = 0;
};

}  // namespace ricochet::finite_duration

#endif  // RICOCHET_CORE_MODELS_FINITE_DURATION_STOP_CHECK_H_
