// Gate: lets as many calls compute at once as there are cores, and decides which.
//
// Three kinds of work have a lane each, with as many slots as cores; the lane of cheap calls has a few for each core.
// Cheap unary calls compute on the threads of their handlers. Dear unary calls compute on threads of low priority, and
// parts of streams on threads of still lower priority, so that the kernel runs what is short first and no call waits
// behind a dear one that has begun.

#ifndef RICOCHET_SERVER_GATE_H_
#define RICOCHET_SERVER_GATE_H_

#include <chrono>
#include <cstddef>
#include <functional>
#include <optional>
#include <stop_token>
#include <string>

#include "absl/functional/function_ref.h"
#include "absl/status/status.h"
#include "server/compute_threads.h"
#include "server/lane.h"
#include "server/request_cost.h"
#include "server/service_times.h"

namespace ricochet::server {

// The number of cores that this process may use, >= 1.
int AvailableCores();

// Turn: a call's request to the gate.
struct Turn {
  std::string peer;  // Peers get fair shares (server/peer.h).
  std::optional<std::chrono::steady_clock::time_point> deadline;
  std::function<bool()> is_gone;    // Says whether the caller has given up.
  std::optional<RequestCost> cost;  // Absent for a part of a stream.
};

// Thread safety: every method may be called from several threads at once.
class Gate {
 public:
  // At most `threads` dear calls and as many parts of streams compute at once, and at most `most_waiting` dear calls wait;
  // both >= 1. Once `drain` is requested, the gate turns away every call that waits and every new one with UNAVAILABLE
  // and kDraining.
  Gate(int threads, int most_waiting, std::stop_token drain);

  // Waits until it is the caller's turn, does the work and returns OK. Does nothing if it returns an error:
  // RESOURCE_EXHAUSTED with kOverloaded and a retry delay, DEADLINE_EXCEEDED, CANCELLED, UNAVAILABLE with kDraining.
  // An exception that `work` throws is thrown here.
  absl::Status Compute(const Turn& turn, absl::FunctionRef<void()> work);

  // Calls of all kinds that wait or compute now.
  size_t waiting() const { return cheap_.waiting() + dear_.waiting() + streams_.waiting(); }
  size_t computing() const { return cheap_.computing() + dear_.computing() + streams_.computing(); }

 private:
  Lane cheap_;
  Lane dear_;
  Lane streams_;
  ServiceTimes times_;
  ComputeThreads dear_threads_;
  ComputeThreads stream_threads_;
  std::stop_callback<std::function<void()>> close_;
};

}  // namespace ricochet::server

#endif  // RICOCHET_SERVER_GATE_H_
