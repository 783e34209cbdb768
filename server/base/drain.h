// Drain: takes a running server out of service, so that no call is lost which another server can answer.
//
//   1. The grace: the server answers as before, while load balancers learn that its health is NOT_SERVING.
//   2. The timeout: new calls are refused with UNAVAILABLE, streams end with it at their next chunk, unary calls
//      finish. This step ends early once no call runs.
//   3. Unary calls that still run are stopped and end with UNAVAILABLE too.
//
// The drain never waits for a peer, only for handlers: an idle connection or an open health watch does not delay it.
// gRPC's own Server::Shutdown is not part of it, because a call that meets it ends with CANCELLED, which clients do not
// repeat; a call that meets a closed connection ends with UNAVAILABLE.

#ifndef RICOCHET_SERVER_BASE_DRAIN_H_
#define RICOCHET_SERVER_BASE_DRAIN_H_

#include <chrono>
#include <functional>
#include <stop_token>

#include "server/base/signals.h"

namespace ricochet::server {

// DrainStops says when handlers must end. Default tokens never ask for it.
struct DrainStops {
  std::stop_token streams;  // Requested after the grace; from then on new calls are refused as well.
  std::stop_token unary;    // Requested after the timeout.
};

class Drain {
 public:
  // The steps take `grace` and at most `timeout`, both >= 0.
  Drain(std::chrono::milliseconds grace, std::chrono::milliseconds timeout) : grace_(grace), timeout_(timeout) {}

  DrainStops stops() const { return {.streams = streams_.get_token(), .unary = unary_.get_token()}; }

  // Goes through the steps. `live_calls` counts the handlers that run. A signal to stop ends the drain at once.
  void Run(const Signals& signals, const std::function<int()>& live_calls);

 private:
  // Waits until no call is live, at most for `time`. Returns true if a signal to stop came.
  static bool WaitForCalls(std::chrono::milliseconds time, const Signals& signals,
                           const std::function<int()>& live_calls);

  const std::chrono::milliseconds grace_;
  const std::chrono::milliseconds timeout_;
  std::stop_source streams_;
  std::stop_source unary_;
};

}  // namespace ricochet::server

#endif  // RICOCHET_SERVER_BASE_DRAIN_H_
