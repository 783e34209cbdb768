// CheckServing: finds out whether this server can serve at all. A server that is full, or that refuses calls for a
// while, can serve; one whose accept loop has ended, or in which no cheap call gets its turn to compute, cannot.

#ifndef RICOCHET_SERVER_HEALTH_SERVING_CHECK_H_
#define RICOCHET_SERVER_HEALTH_SERVING_CHECK_H_

#include <chrono>
#include <stop_token>
#include <vector>

#include "absl/status/status.h"
#include "server/admission/scheduler.h"
#include "server/base/listen_address.h"
#include "server/transport/acceptor.h"

namespace ricochet::server {

// Connects to every address and waits until the acceptor, which listens there, has noticed; then waits for a turn at
// the scheduler. Each step may take `patience`. Returns OK early once `stop` is requested.
// Errors: UNAVAILABLE that says what does not work.
absl::Status CheckServing(const std::vector<ListenAddress>& addresses, const Acceptor& acceptor, Scheduler& scheduler,
                          std::chrono::milliseconds patience, const std::stop_token& stop);

}  // namespace ricochet::server

#endif  // RICOCHET_SERVER_HEALTH_SERVING_CHECK_H_
