// Names of models and reasons in the log and in the metrics.

#ifndef RICOCHET_SERVER_BASE_TELEMETRY_NAMES_H_
#define RICOCHET_SERVER_BASE_TELEMETRY_NAMES_H_

#include <cstddef>
#include <string>
#include <vector>

#include "ricochet/error.h"

namespace ricochet::server {

// Reasons of calls that end before a handler sees them: by gRPC, or because of who makes them.
inline constexpr char kMalformedReason[] = "MALFORMED_REQUEST";
inline constexpr char kThreadsReason[] = "THREADS_EXHAUSTED";
inline constexpr char kUnknownMethodReason[] = "UNKNOWN_METHOD";
inline constexpr char kRefusedByGrpcReason[] = "REFUSED_BY_GRPC";
inline constexpr char kUnauthenticatedReason[] = "UNAUTHENTICATED";
inline constexpr char kPermissionDeniedReason[] = "PERMISSION_DENIED";

// Returns every reason that a failed call can have: those above, and those of google.rpc.ErrorInfo.
const std::vector<std::string>& Reasons();

// Returns a reason as google.rpc.ErrorInfo spells it, such as "TOO_MANY_CALLS"; an empty text for none.
std::string ReasonName(ErrorReason reason);

// Returns the name of the model of a number, such as "pendulum".
std::string ModelName(size_t model);

}  // namespace ricochet::server

#endif  // RICOCHET_SERVER_BASE_TELEMETRY_NAMES_H_
