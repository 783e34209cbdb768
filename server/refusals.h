// Refusals: the errors with which the server itself, and not the solver, ends a call. Each has a reason and says when to
// try again.

#ifndef RICOCHET_SERVER_REFUSALS_H_
#define RICOCHET_SERVER_REFUSALS_H_

#include <cstdint>

#include "absl/status/status.h"

namespace ricochet::server {

// RESOURCE_EXHAUSTED: the server is at its limit of live calls.
absl::Status TooManyCalls(int limit);

// RESOURCE_EXHAUSTED: a sweep of `points` points exceeds the limit of one call.
absl::Status SweepTooLarge(int64_t points, int64_t limit);

// UNAVAILABLE: the server drains.
absl::Status Draining();

}  // namespace ricochet::server

#endif  // RICOCHET_SERVER_REFUSALS_H_
