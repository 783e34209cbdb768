// Reflection: describes the service to clients that have no proto files, at an address of its own.
//
// An open reflection stream holds a thread for as long as its client likes. On the address of the service, a few
// hundred idle streams would take every thread from the calls; here they can harm nothing but reflection.

#ifndef RICOCHET_SERVER_HEALTH_REFLECTION_H_
#define RICOCHET_SERVER_HEALTH_REFLECTION_H_

#include <memory>

#include "absl/status/statusor.h"
#include "grpc/health/v1/health.grpc.pb.h"
#include "ricochet/v1/impact_service.grpc.pb.h"
#include "server/calls/reflection_service.h"
#include "server/transport/endpoint.h"

namespace ricochet::server {

class Reflection {
 public:
  // Opens the endpoint, within small limits of its own in place of those of `settings`. It serves health, and
  // reflection by version 1 of its protocol and by v1alpha, which older clients ask for. The methods of
  // ricochet.v1.ImpactService are described, but a call of one gets UNIMPLEMENTED. `log` must outlive the object.
  // Errors: UNAVAILABLE if it cannot listen.
  static absl::StatusOr<std::unique_ptr<Reflection>> Open(Endpoint::Settings settings, const Log& log);

  Endpoint& endpoint() { return *endpoint_; }

 private:
  Reflection() = default;

  v1::ImpactService::Service described_;
  ReflectionService version_1_{{v1::ImpactService::service_full_name(), grpc::health::v1::Health::service_full_name(),
                                grpc::reflection::v1::ServerReflection::service_full_name(),
                                "grpc.reflection.v1alpha.ServerReflection"}};
  std::unique_ptr<Endpoint> endpoint_;
};

}  // namespace ricochet::server

#endif  // RICOCHET_SERVER_HEALTH_REFLECTION_H_
