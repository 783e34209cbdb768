// Refusals: the errors with which the server itself, and not the solver, ends a call. Each has a reason and says when
// to try again.

#ifndef RICOCHET_SERVER_BASE_REFUSALS_H_
#define RICOCHET_SERVER_BASE_REFUSALS_H_

#include <chrono>
#include <cstdint>
#include <string>

#include "absl/status/status.h"

namespace ricochet::server {

// RESOURCE_EXHAUSTED: the server is at its limit of live calls or streams. `what` is "live calls" or "streams".
absl::Status TooManyCalls(const std::string& what, int limit);

// RESOURCE_EXHAUSTED: a peer is at its own limit of live calls or streams. `what` is "live calls" or "streams".
absl::Status TooManyCallsOfPeer(const std::string& what, int limit);

// RESOURCE_EXHAUSTED: the requests and answers of all calls, or of this peer's, hold as many bytes as they may.
absl::Status NoMemory(int64_t limit);
absl::Status NoMemoryOfPeer(int64_t limit);

// RESOURCE_EXHAUSTED: the server has no thread that could run another handler.
absl::Status NoThread();

// RESOURCE_EXHAUSTED: the work that waits to be computed would take `wait` before it is the turn of a new call.
absl::Status Overloaded(std::chrono::duration<double> wait);

// RESOURCE_EXHAUSTED: `most` calls, as many as may, wait to be computed. The work before them takes `wait`.
absl::Status QueueFull(size_t most, std::chrono::duration<double> wait);

// DEADLINE_EXCEEDED: a unary call has taken `limit`, the longest time that the server allows.
absl::Status TimeLimitReached(std::chrono::milliseconds limit);

// UNAVAILABLE: a stream has run for `limit`, the greatest age that the server allows.
absl::Status AgeLimitReached(std::chrono::milliseconds limit);

// CANCELLED: the caller has read nothing for `limit`. The caller cannot see more than the code.
absl::Status UnreadLimitReached(std::chrono::milliseconds limit);
// CANCELLED: the caller of a stream of batches has sent nothing for `limit`, and cannot see more either.
absl::Status PauseLimitReached(std::chrono::milliseconds limit);

// UNAUTHENTICATED: the token or certificate of a call that runs is no longer among those that the server knows.
absl::Status CallerRemoved();

// UNAVAILABLE: the server drains.
absl::Status Draining();

}  // namespace ricochet::server

#endif  // RICOCHET_SERVER_BASE_REFUSALS_H_
