// CheckHealth: asks by the public protocol grpc.health.v1 whether a service of a server takes calls.

#ifndef RICOCHET_HEALTH_H_
#define RICOCHET_HEALTH_H_

#include <string>

#include "absl/status/statusor.h"
#include "ricochet/client_options.h"

namespace ricochet {

// The numbers are those of grpc.health.v1.HealthCheckResponse.ServingStatus.
enum class Health {
  kUnknown = 0,
  kServing = 1,
  kNotServing = 2,  // The server is starting or shutting down.
};

// Asks for the health of `service`, given by its full name; an empty name means the server as a whole. It waits for
// ClientOptions::deadline at most. Of a list of servers the first that can be reached answers.
// Errors: INVALID_ARGUMENT for invalid options, NOT_FOUND for a service that the server does not know, UNAVAILABLE and
// DEADLINE_EXCEEDED of the network, FAILED_PRECONDITION for a server that is not trusted or does not speak TLS.
absl::StatusOr<Health> CheckHealth(const ClientOptions& options, const std::string& service);

}  // namespace ricochet

#endif  // RICOCHET_HEALTH_H_
