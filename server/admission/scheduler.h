// Scheduler: lets as many calls compute at once as there are cores, and decides which.
//
// Three kinds of work have a queue each, with as many slots as cores; the queue of cheap calls has a few for each core.
// Cheap unary calls compute on the threads of their handlers. Expensive unary calls compute on threads of low priority,
// and parts of streams on threads of still lower priority, so that the kernel runs what is short first and no call
// waits behind an expensive one that has begun.

#ifndef RICOCHET_SERVER_ADMISSION_SCHEDULER_H_
#define RICOCHET_SERVER_ADMISSION_SCHEDULER_H_

#include <chrono>
#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>

#include "absl/functional/function_ref.h"
#include "absl/status/status.h"
#include "ricochet/helpers.h"
#include "server/admission/compute_threads.h"
#include "server/admission/request_cost.h"
#include "server/admission/service_times.h"
#include "server/admission/slot_queue.h"

namespace ricochet::server {

// ComputeRequest: a call's request to the scheduler.
struct ComputeRequest {
  std::string peer;  // Peers get fair shares (server/security/peer.h).
  std::optional<std::chrono::steady_clock::time_point> deadline;
  std::function<bool()> is_gone;    // Says whether the caller has given up.
  std::optional<RequestCost> cost;  // Absent for a part of a stream.
};

// Thread safety: every method may be called from several threads at once.
class Scheduler {
 public:
  // At most `threads` expensive calls and as many parts of streams compute at once, and at most `most_waiting`
  // expensive calls wait; both >= 1. Once `drain` is requested, the scheduler turns away every call that waits and
  // every new one with UNAVAILABLE and kDraining.
  Scheduler(int threads, int most_waiting, std::stop_token drain);

  // Waits until it is the caller's turn, does the work and returns OK. Does nothing if it returns an error:
  // RESOURCE_EXHAUSTED with kOverloaded and a retry delay, DEADLINE_EXCEEDED, CANCELLED, UNAVAILABLE with kDraining.
  // An exception that `work` throws is thrown here.
  absl::Status Compute(const ComputeRequest& request, absl::FunctionRef<void()> work);

  // Returns helpers for a sweep or a batch of a peer. A helper takes a slot for parts of streams, and its time counts
  // as its peer's. It gets one only while fewer expensive calls and parts of streams compute than there are threads and
  // none waits, and gives it back once that no longer holds. The scheduler must outlive the helpers.
  std::shared_ptr<Helpers> HelpersFor(std::string peer);

  // Calls of all kinds that wait or compute now. A helper counts as one that computes.
  size_t waiting() const { return cheap_.waiting() + expensive_.waiting() + streams_.waiting(); }
  size_t computing() const { return cheap_.computing() + expensive_.computing() + streams_.computing(); }

 private:
  class SweepHelpers;
  // True if the calls that compute or wait leave no thread for a helper, of whom `helpers` compute now.
  bool IsFull(size_t helpers) const;
  bool StartHelp(const std::string& peer, Helpers::Help help);

  const size_t threads_;
  SlotQueue cheap_;
  SlotQueue expensive_;
  SlotQueue streams_;
  ServiceTimes times_;
  ComputeThreads expensive_threads_;
  ComputeThreads stream_threads_;
  std::stop_callback<std::function<void()>> close_;
};

}  // namespace ricochet::server

#endif  // RICOCHET_SERVER_ADMISSION_SCHEDULER_H_
