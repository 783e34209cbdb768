#include "ricochet/health.h"

#include <grpcpp/client_context.h>

#include <utility>

#include "client/channel.h"
#include "grpc/health/v1/health.grpc.pb.h"
#include "proto/wire/status.h"

namespace ricochet {

absl::StatusOr<Health> CheckHealth(const ClientOptions& options, const std::string& service) {
  absl::StatusOr<std::shared_ptr<grpc::Channel>> channel = MakeChannel(options);
  if (!channel.ok()) return channel.status();
  const auto stub = grpc::health::v1::Health::NewStub(*std::move(channel));
  grpc::ClientContext context;
  context.set_deadline(std::chrono::system_clock::now() + options.deadline);
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

}  // namespace ricochet
