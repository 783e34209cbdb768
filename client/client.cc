#include "ricochet/client.h"

#include <utility>

#include "client/channel.h"
#include "client/sweep_reader.h"
#include "proto/wire/audit.h"
#include "proto/wire/requests.h"
#include "proto/wire/status.h"
#include "proto/wire/sweep.h"
#include "ricochet/v1/impact_service.grpc.pb.h"

namespace ricochet {

struct Client::Connection {
  ClientOptions options;
  std::unique_ptr<v1::ImpactService::StubInterface> stub;
};

namespace {

// Sends a unary call: converts the request to its proto, calls, and converts the response back.
template <typename Response, typename WireResponse, typename Request, typename Call>
absl::StatusOr<Response> Ask(const ClientOptions& options, const Request& request, Call call) {
  grpc::ClientContext context;
  context.set_deadline(std::chrono::system_clock::now() + options.deadline);
  WireResponse response;
  const grpc::Status status = call(&context, ToProto(request), &response);
  if (!status.ok()) return FromGrpcStatus(status);
  return FromProto(response);
}

}  // namespace

absl::StatusOr<Client> Client::Connect(const ClientOptions& options) {
  absl::StatusOr<std::shared_ptr<grpc::Channel>> channel = MakeChannel(options);
  if (!channel.ok()) return channel.status();
  return Client(std::make_shared<Connection>(Connection{options, v1::ImpactService::NewStub(*std::move(channel))}));
}

absl::StatusOr<SolveResponse> Client::Solve(const SolveRequest& request) const {
  return Ask<SolveResponse, v1::SolveResponse>(connection_->options, request,
                                               [this](auto* context, const auto& asked, auto* response) {
                                                 return connection_->stub->Solve(context, asked, response);
                                               });
}

absl::StatusOr<BoundsResponse> Client::Bounds(const BoundsRequest& request) const {
  return Ask<BoundsResponse, v1::BoundsResponse>(connection_->options, request,
                                                 [this](auto* context, const auto& asked, auto* response) {
                                                   return connection_->stub->Bounds(context, asked, response);
                                                 });
}

absl::StatusOr<AuditResponse> Client::Audit(const AuditRequest& request) const {
  return Ask<AuditResponse, v1::AuditResponse>(connection_->options, request,
                                               [this](auto* context, const auto& asked, auto* response) {
                                                 return connection_->stub->Audit(context, asked, response);
                                               });
}

absl::StatusOr<AuditBatchResponse> Client::AuditBatch(const AuditBatchRequest& request) const {
  return Ask<AuditBatchResponse, v1::AuditBatchResponse>(
      connection_->options, request, [this](auto* context, const auto& asked, auto* response) {
        return connection_->stub->AuditBatch(context, asked, response);
      });
}

SweepStream Client::Sweep(const SweepRequest& request, std::stop_token stop) const {
  auto reader = std::make_shared<SweepReader>(
      [&](grpc::ClientContext* context) { return connection_->stub->Sweep(context, ToProto(request)); }, request,
      connection_->options.sweep_deadline, std::move(stop));
  // The stream keeps the connection, so it may outlive the Client that made it.
  return SweepStream([connection = connection_, reader = std::move(reader)] { return reader->Next(); });
}

}  // namespace ricochet
