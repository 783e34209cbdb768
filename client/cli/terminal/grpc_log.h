// The log of gRPC, which belongs to developers: a user sees the error of the call instead.

#ifndef RICOCHET_CLIENT_CLI_TERMINAL_GRPC_LOG_H_
#define RICOCHET_CLIENT_CLI_TERMINAL_GRPC_LOG_H_

#include "absl/status/status.h"

namespace ricochet::cli {

// Keeps gRPC from writing to standard error, unless GRPC_VERBOSITY in the environment asks for its log. Call it before
// any call.
void QuietGrpc();

// Returns the status of a run. A proxy may refuse this client's certificate after the handshake, and gRPC then says why
// in its log alone: an UNAVAILABLE of that kind becomes FAILED_PRECONDITION with the alert, because no retry mends it.
// A server of gRPC closes the connection without an alert, as one without room does, which remains UNAVAILABLE.
absl::Status WithTlsAlert(const absl::Status& status);

}  // namespace ricochet::cli

#endif  // RICOCHET_CLIENT_CLI_TERMINAL_GRPC_LOG_H_
