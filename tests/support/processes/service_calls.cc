#include "tests/support/processes/service_calls.h"

#include <grpcpp/create_channel.h>
#include <grpcpp/security/credentials.h>

#include "proto/wire/status.h"

namespace ricochet {

std::shared_ptr<grpc::Channel> MakeChannel(const std::string& address) {
  grpc::ChannelArguments arguments;
  // Otherwise channels to one address share a connection, and a test sees the server of another test end.
  arguments.SetInt(GRPC_ARG_USE_LOCAL_SUBCHANNEL_POOL, 1);
  return grpc::CreateCustomChannel(address, grpc::InsecureChannelCredentials(), arguments);
}

std::unique_ptr<v1::ImpactService::Stub> MakeStub(const ServerProcess& server) {
  return v1::ImpactService::NewStub(MakeChannel(server.address()));
}

v1::Scene PaperScene() {
  v1::Scene scene;
  scene.mutable_pendulum()->set_inertia_kg_m2(1.0);
  scene.mutable_pendulum()->set_a_m(0.3);
  scene.mutable_pendulum()->set_b_m(1.0);
  scene.mutable_pendulum()->set_omega_minus_rad_s(-1.0);
  scene.mutable_friction()->set_kinetic_coefficient(0.1);
  scene.mutable_restitution()->set_energetic(1.0);
  return scene;
}

v1::SweepRequest SweepOf(int64_t points) {
  v1::SweepRequest request;
  *request.mutable_scene() = PaperScene();
  v1::Axis& axis = *request.add_axes();
  axis.set_path("friction.kinetic_coefficient");
  axis.mutable_linspace()->set_start(0.0);
  axis.mutable_linspace()->set_stop(0.5);
  axis.mutable_linspace()->set_count(points);
  request.add_columns("coefficients.newton");
  return request;
}

absl::Status Solve(v1::ImpactService::Stub& stub, const v1::Scene& scene, v1::SolveResponse* response) {
  grpc::ClientContext context;
  context.set_deadline(std::chrono::system_clock::now() + std::chrono::seconds(10));
  v1::SolveRequest request;
  *request.mutable_scene() = scene;
  return FromGrpcStatus(stub.Solve(&context, request, response));
}

absl::Status Solve(v1::ImpactService::Stub& stub, const v1::Scene& scene) {
  v1::SolveResponse response;
  return Solve(stub, scene, &response);
}

RunningSweep::RunningSweep(v1::ImpactService::Stub& stub, const v1::SweepRequest& request,
                           std::optional<std::chrono::milliseconds> deadline) {
  if (deadline.has_value()) context_.set_deadline(std::chrono::system_clock::now() + *deadline);
  reader_ = stub.Sweep(&context_, request);
}

absl::Status RunningSweep::Drain() {
  v1::SweepResponse chunk;
  while (reader_->Read(&chunk)) {
  }
  return FromGrpcStatus(reader_->Finish());
}

}  // namespace ricochet
