// FinalFailure: says of a call that has failed on every server whether a retry can help.
//
// gRPC calls every failed connection UNAVAILABLE and every message that is too large RESOURCE_EXHAUSTED, which both ask
// for a retry. No retry helps if a server's certificate is not trusted, if a server does not speak TLS, or if a message
// exceeds a limit.

#ifndef RICOCHET_CLIENT_FINAL_FAILURE_H_
#define RICOCHET_CLIENT_FINAL_FAILURE_H_

#include "absl/status/status.h"

namespace ricochet {

// Returns the status for the caller. An UNAVAILABLE by which gRPC says that a connection was refused for good becomes
// FAILED_PRECONDITION with the cause in words before gRPC's own, and a message that is too large gets the reason
// kLimitExceeded. A DEADLINE_EXCEEDED names the option that gives more time. Every other status stays as it is.
absl::Status ExplainFailure(const absl::Status& status);

// True if ExplainFailure has found that the server closed the connection, for which TLS may be the reason.
bool IsClosedByServer(const absl::Status& status);

}  // namespace ricochet

#endif  // RICOCHET_CLIENT_FINAL_FAILURE_H_
