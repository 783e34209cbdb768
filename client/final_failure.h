// FinalFailure: what the failure of a call means once it has been tried on every server: whether a retry can mend it.
//
// gRPC calls every failed connection UNAVAILABLE and every message that is too large RESOURCE_EXHAUSTED, which both ask
// to be tried again. Some of them no retry can mend: a server whose certificate is not trusted, or that does not speak
// TLS, and a limit on a message.

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
