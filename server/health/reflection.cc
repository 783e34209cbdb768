#include "server/health/reflection.h"

#include <google/protobuf/generated_message_reflection.h>
#include <grpcpp/ext/proto_server_reflection_plugin.h>
#include <grpcpp/health_check_service_interface.h>
#include <grpcpp/server_builder.h>

#include <utility>

#include "google/rpc/error_details.pb.h"
#include "grpc/health/v1/health.grpc.pb.h"
#include "server/transport/transport.h"

namespace ricochet::server {
namespace {

constexpr TransportLimits kLimits = {.max_threads = 16, .memory_bytes = 16 << 20};
constexpr ConnectionLimits kConnections = {.in_all = 64, .per_peer = 32};

// Keeps the descriptions linked of messages that no code of the server uses itself: those of health, which gRPC serves
// by code of its own, and the details of errors.
void LinkDescriptions() {
  google::protobuf::LinkMessageReflection<grpc::health::v1::HealthCheckRequest>();
  google::protobuf::LinkMessageReflection<google::rpc::BadRequest>();
}

}  // namespace

absl::StatusOr<std::unique_ptr<Reflection>> Reflection::Open(Endpoint::Settings settings, const Log& log) {
  std::unique_ptr<Reflection> reflection(new Reflection());
  LinkDescriptions();
  // Keeps the library linked whose start-up code adds reflection to every server that does not leave it out.
  grpc::reflection::InitProtoReflectionServerBuilderPlugin();
  grpc::ServerBuilder builder;
  SetTransport(kLimits, builder);
  builder.RegisterService(&reflection->described_);
  builder.RegisterService(&reflection->version_1_);
  settings.connections = kConnections;
  absl::StatusOr<std::unique_ptr<Endpoint>> endpoint = Endpoint::Open(settings, builder, log);
  if (!endpoint.ok()) return endpoint.status();
  reflection->endpoint_ = *std::move(endpoint);
  return reflection;
}

}  // namespace ricochet::server
