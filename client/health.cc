#include "ricochet/health.h"

#include <grpcpp/client_context.h>

#include "client/channel.h"
#include "client/final_failure.h"
#include "core/base/try.h"
#include "grpc/health/v1/health.grpc.pb.h"
#include "proto/wire/status.h"

namespace ricochet {

static absl::StatusOr<Health> AskHealth(const std::shared_ptr<grpc::Channel>& channel,
                                        std::chrono::milliseconds deadline, const std::string& service) {
  const auto stub = grpc::health::v1::Health::NewStub(channel);
  grpc::ClientContext context;
  context.set_deadline(std::chrono::system_clock::now() + deadline);
  grpc::health::v1::HealthCheckRequest request;
  request.set_service(service);
  grpc::health::v1::HealthCheckResponse response;
  const grpc::Status status = stub->Check(&context, request, &response);
  if (!status.ok()) return FromGrpcStatus(status);
  switch (response.status()) {
    case grpc::health::v1::HealthCheckResponse::SERVING:
      return Health::kServing;
    case grpc::health::v1::HealthCheckResponse::NOT_SERVING:
      return Health::kNotServing;
    default:
      return Health::kUnknown;
  }
}

absl::StatusOr<Health> CheckHealth(const ClientOptions& options, const std::string& service) {
  RICOCHET_TRY(const auto channels, MakeChannels(options));
  absl::StatusOr<Health> health;
  for (const std::shared_ptr<grpc::Channel>& channel : channels) {
    health = AskHealth(channel, options.deadline, service);
    if (!absl::IsUnavailable(health.status())) break;
  }
  if (!health.ok()) return ExplainFailure(health.status());
  return health;
}

}  // namespace ricochet
