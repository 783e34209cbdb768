// Refusals: the errors with which the server itself, and not the solver, ends a call. Each has a reason and says when to
// try again.

#ifndef RICOCHET_SERVER_REFUSALS_H_
#define RICOCHET_SERVER_REFUSALS_H_

#include "absl/status/status.h"

namespace ricochet::server {

// RESOURCE_EXHAUSTED: the server is at its limit of live calls.
absl::Status TooManyCalls(int limit);

// UNAVAILABLE: the server drains.
absl::Status Draining();

}  // namespace ricochet::server

#endif  // RICOCHET_SERVER_REFUSALS_H_
