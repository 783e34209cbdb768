// ConnectionFailure: what it means for a caller that gRPC could not connect to a server.
//
// gRPC calls every failed connection UNAVAILABLE, which asks to be tried again. Some of them no retry can mend: a server
// whose certificate is not trusted, or that does not speak TLS.

#ifndef RICOCHET_CLIENT_CONNECTION_FAILURE_H_
#define RICOCHET_CLIENT_CONNECTION_FAILURE_H_

#include "absl/status/status.h"

namespace ricochet {

// Returns the final status of a call. An UNAVAILABLE by which gRPC says that a connection was refused for good becomes
// FAILED_PRECONDITION, with the cause in words before gRPC's own; every other status stays as it is. Calls are tried again, and on
// other servers, before this is asked.
absl::Status ExplainConnection(const absl::Status& status);

}  // namespace ricochet

#endif  // RICOCHET_CLIENT_CONNECTION_FAILURE_H_
