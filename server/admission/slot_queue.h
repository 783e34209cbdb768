// SlotQueue: the slots in which calls of one kind compute, and the queue in front of them.
//
// A call leaves the queue when a slot is free and it is its turn (server/admission/fair_queue.h), when its deadline
// passes, when its caller gives up, or when the queue closes. One that would wait until it is too late is refused when
// it arrives.

#ifndef RICOCHET_SERVER_ADMISSION_SLOT_QUEUE_H_
#define RICOCHET_SERVER_ADMISSION_SLOT_QUEUE_H_

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
class SlotQueue {
 public:
  using Time = std::chrono::steady_clock::time_point;

  // A call in this queue. It must stay where it is from Enter to Leave.
  struct Waiter : FairQueue::Item {
   private:
    friend class SlotQueue;
    enum class State { kWaiting, kComputing, kTurnedAway };
    State state_ = State::kWaiting;
    Time started_;
    std::list<const Waiter*>::iterator place_;
    std::condition_variable changed_;
  };

  // At most `slots` calls compute at once and `most_waiting` wait; both >= 1.
  SlotQueue(int slots, size_t most_waiting) : slots_(static_cast<size_t>(slots)), most_waiting_(most_waiting) {}

  // Waits for the waiter's turn. Every OK must be followed by Leave. Asks `is_gone` now and then, on this thread,
  // whether the caller has given up.
  // Errors: RESOURCE_EXHAUSTED with kOverloaded, DEADLINE_EXCEEDED, CANCELLED, and UNAVAILABLE with kDraining.
  absl::Status Enter(Waiter& waiter, absl::FunctionRef<bool()> is_gone);

  // Takes a slot if one is free and no call waits, and returns whether it did. Every true must be followed by Leave.
  bool TryEnter(Waiter& waiter);

  // Frees the slot of the waiter. Returns the seconds that it has computed.
  double Leave(Waiter& waiter);

  // Turns away every call that waits, and all later ones.
  void Close();

  size_t waiting() const;
  size_t computing() const;

 private:
  // The functions below are called with the mutex locked.
  void LetIn();
  void Start(Waiter& waiter);
  // Returns the seconds that a waiter would wait now.
  double ExpectedWait(const Waiter& waiter) const;
  absl::Status WhyRefused(const Waiter& waiter) const;
  // Waits until `end`, or until it is the waiter's turn, its deadline passes, its caller gives up or the queue closes.
  absl::Status WaitUntil(Time end, Waiter& waiter, absl::FunctionRef<bool()> is_gone,
                         std::unique_lock<std::mutex>& lock);

  const size_t slots_;
  const size_t most_waiting_;
  mutable std::mutex mutex_;
  FairQueue queue_;
  RefusalPace pace_;
  std::list<const Waiter*> computing_;
  std::list<Waiter*> refused_;  // Waiters that are to be told that they are refused.
  bool closed_ = false;
};

}  // namespace ricochet::server

#endif  // RICOCHET_SERVER_ADMISSION_SLOT_QUEUE_H_
