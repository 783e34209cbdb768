// Lane: the slots in which calls of one kind compute, and the queue in front of them.
//
// A call leaves the queue when a slot is free and it is its turn (server/admission/fair_queue.h), when its deadline
// passes, when its caller gives up, or when the lane closes. One that would wait until it is too late is refused when
// it arrives.

#ifndef RICOCHET_SERVER_ADMISSION_LANE_H_
#define RICOCHET_SERVER_ADMISSION_LANE_H_

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <list>
#include <mutex>

#include "absl/functional/function_ref.h"
#include "absl/status/status.h"
#include "server/admission/fair_queue.h"
#include "server/base/refusal_pace.h"

namespace ricochet::server {

// Thread safety: every method may be called from several threads at once.
class Lane {
 public:
  using Time = std::chrono::steady_clock::time_point;

  // A call in this lane. It must stay where it is from Enter to Leave.
  struct Visitor : FairQueue::Item {
   private:
    friend class Lane;
    enum class State { kWaiting, kComputing, kTurnedAway };
    State state = State::kWaiting;
    Time started;
    std::list<const Visitor*>::iterator place;
    std::condition_variable turn;
  };

  // At most `slots` calls compute at once and `most_waiting` wait; both >= 1.
  Lane(int slots, size_t most_waiting) : slots_(static_cast<size_t>(slots)), most_waiting_(most_waiting) {}

  // Waits for the visitor's turn. Every OK must be followed by Leave. Asks `is_gone` now and then, on this thread,
  // whether the caller has given up.
  // Errors: RESOURCE_EXHAUSTED with kOverloaded, DEADLINE_EXCEEDED, CANCELLED, and UNAVAILABLE with kDraining.
  absl::Status Enter(Visitor& visitor, absl::FunctionRef<bool()> is_gone);

  // Takes a slot if one is free and no call waits, and returns whether it did. Every true must be followed by Leave.
  bool TryEnter(Visitor& visitor);

  // Frees the slot of the visitor. Returns the seconds that it has computed.
  double Leave(Visitor& visitor);

  // Turns away every call that waits, and all later ones.
  void Close();

  size_t waiting() const;
  size_t computing() const;

 private:
  // The functions below are called with the mutex locked.
  void LetIn();
  void Start(Visitor& visitor);
  // Returns the seconds that a visitor would wait now.
  double ExpectedWait(const Visitor& visitor) const;
  absl::Status WhyRefused(const Visitor& visitor) const;
  // Waits until `end`, or until it is the visitor's turn, its deadline passes, its caller gives up or the lane closes.
  absl::Status WaitUntil(Time end, Visitor& visitor, absl::FunctionRef<bool()> is_gone,
                         std::unique_lock<std::mutex>& lock);

  const size_t slots_;
  const size_t most_waiting_;
  mutable std::mutex mutex_;
  FairQueue queue_;
  RefusalPace pace_;
  std::list<const Visitor*> computing_;
  std::list<Visitor*> refused_;  // Visitors that wait to be told that they are refused.
  bool closed_ = false;
};

}  // namespace ricochet::server

#endif  // RICOCHET_SERVER_ADMISSION_LANE_H_
