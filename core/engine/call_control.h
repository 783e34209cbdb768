// CallControl: looks at the clock and at the options of a call while it is computed.
//
// Computations ask IsStopped as often as they like, down to every microsecond. It reads the clock each time, which
// takes some 25 ns, and looks at the options themselves at most once a millisecond, because that may take a lock.

#ifndef RICOCHET_CORE_ENGINE_CALL_CONTROL_H_
#define RICOCHET_CORE_ENGINE_CALL_CONTROL_H_

#include <chrono>
#include <utility>

#include "absl/status/status.h"
#include "ricochet/call_options.h"

namespace ricochet {

class CallControl {
 public:
  explicit CallControl(CallOptions options) : options_(std::move(options)) {}

  // Returns the error with which the options end the call by now, or OK if it may go on.
  absl::Status WhyEnded() const;

  // Returns `error`; but if it only says that a computation was stopped, the reason why the options ended the call.
  absl::Status OrWhyEnded(const absl::Status& error) const;

  // True once the options have ended the call; then it stays true.
  bool IsStopped();

  // Starts a piece of the answer, which takes long enough after `time`. The next question looks at the options, because
  // the caller may have waited long since the last one.
  void StartPiece(std::chrono::milliseconds time);
  // True if the piece took long enough when IsStopped was asked last.
  bool PieceTookLongEnough() const { return now_ >= piece_end_; }

 private:
  using Clock = std::chrono::steady_clock;

  CallOptions options_;
  Clock::time_point now_ = Clock::time_point::min();  // The time of the last question.
  Clock::time_point next_look_ = Clock::time_point::min();
  Clock::time_point piece_end_ = Clock::time_point::max();
  bool is_stopped_ = false;
};

}  // namespace ricochet

#endif  // RICOCHET_CORE_ENGINE_CALL_CONTROL_H_
