// Names of models and reasons in the log and in the metrics.

#ifndef RICOCHET_SERVER_BASE_TELEMETRY_NAMES_H_
#define RICOCHET_SERVER_BASE_TELEMETRY_NAMES_H_

#include <cstddef>
#include <string>

#include "absl/strings/string_view.h"
#include "ricochet/error.h"

namespace ricochet::server {

// Reasons of calls that gRPC ends before a handler sees them.
inline constexpr char kMalformedReason[] = "MALFORMED_REQUEST";
inline constexpr char kThreadsReason[] = "THREADS_EXHAUSTED";
inline constexpr char kUnknownMethodReason[] = "UNKNOWN_METHOD";
inline constexpr char kRefusedByGrpcReason[] = "REFUSED_BY_GRPC";

// Returns true for one of the four reasons above.
bool IsTransportReason(absl::string_view reason);

// Returns a reason as google.rpc.ErrorInfo spells it, such as "TOO_MANY_CALLS"; an empty text for none.
std::string ReasonName(ErrorReason reason);

// Returns the name of the model of a number, such as "pendulum".
std::string ModelName(size_t model);

}  // namespace ricochet::server

#endif  // RICOCHET_SERVER_BASE_TELEMETRY_NAMES_H_
