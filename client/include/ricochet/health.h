// CheckHealth: is a service of a server taking calls? The public protocol grpc.health.v1.

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
  kNotServing = 2,  // Starting or draining.
};

// The health of `service`, by full name; empty for the server as a whole.
// Errors: INVALID_ARGUMENT for invalid options, NOT_FOUND for a service that the server does not know, those of the
// network.
absl::StatusOr<Health> CheckHealth(const ClientOptions& options, const std::string& service);

}  // namespace ricochet

#endif  // RICOCHET_HEALTH_H_
