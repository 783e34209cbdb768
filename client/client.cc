#include "ricochet/client.h"

#include <utility>

#include "client/call_context.h"
#include "client/channel.h"
#include "client/cost_reader.h"
#include "client/sweep_reader.h"
#include "proto/wire/audit.h"
#include "proto/wire/cost.h"
#include "proto/wire/requests.h"
#include "proto/wire/status.h"
#include "proto/wire/sweep.h"
#include "ricochet/v1/impact_service.grpc.pb.h"

namespace ricochet {
namespace {

using Stub = v1::ImpactService::StubInterface;

// A unary method of the service.
template <typename WireRequest, typename WireResponse>
using Method = grpc::Status (Stub::*)(grpc::ClientContext*, const WireRequest&, WireResponse*);

}  // namespace

struct Client::Connection {
  ClientOptions options;
  std::unique_ptr<Stub> stub;

  // Converts the request to its proto, calls `method`, and converts the response back.
  template <typename Request, typename WireRequest, typename WireResponse>
  auto Ask(Method<WireRequest, WireResponse> method, const Request& request, const CallOptions& call) const
      -> absl::StatusOr<decltype(FromProto(WireResponse()))> {
    if (IsStopped(call)) return StoppedByCaller();
    CallContext context(call, options.deadline);
    WireResponse response;
    const grpc::Status status = ((*stub).*method)(&context.get(), ToProto(request), &response);
    if (status.ok()) return FromProto(response);
    return IsStopped(call) ? StoppedByCaller() : FromGrpcStatus(status);
  }
};

absl::StatusOr<Client> Client::Connect(const ClientOptions& options) {
  absl::StatusOr<std::shared_ptr<grpc::Channel>> channel = MakeChannel(options);
  if (!channel.ok()) return channel.status();
  return Client(std::make_shared<Connection>(Connection{options, v1::ImpactService::NewStub(*std::move(channel))}));
}

absl::StatusOr<SolveResponse> Client::DoSolve(const SolveRequest& request, const CallOptions& options) const {
  return connection_->Ask(&Stub::Solve, request, options);
}

absl::StatusOr<PlanResponse> Client::DoPlan(const PlanRequest& request, const CallOptions& options) const {
  return connection_->Ask(&Stub::Plan, request, options);
}

absl::StatusOr<BoundsResponse> Client::DoBounds(const BoundsRequest& request, const CallOptions& options) const {
  return connection_->Ask(&Stub::Bounds, request, options);
}

absl::StatusOr<AuditResponse> Client::DoAudit(const AuditRequest& request, const CallOptions& options) const {
  return connection_->Ask(&Stub::Audit, request, options);
}

absl::StatusOr<AuditBatchResponse> Client::DoAuditBatch(const AuditBatchRequest& request,
                                                        const CallOptions& options) const {
  return connection_->Ask(&Stub::AuditBatch, request, options);
}

SweepStream Client::DoSweep(const SweepRequest& request, const CallOptions& options) const {
  auto reader = std::make_shared<SweepReader>(
      [&](grpc::ClientContext* context) { return connection_->stub->Sweep(context, ToProto(request)); },
      ChunkChecker(request), connection_->options.sweep_deadline, options);
  // The stream keeps the connection, so it may outlive the Client that made it.
  return SweepStream([connection = connection_, reader = std::move(reader)] { return reader->Next(); });
}

CostStream Client::DoCost(const CostRequest& request, const CallOptions& options) const {
  auto reader = std::make_shared<CostReader>(
      [&](grpc::ClientContext* context) { return connection_->stub->Cost(context, ToProto(request)); }, CostChecker(),
      connection_->options.sweep_deadline, options);
  return CostStream([connection = connection_, reader = std::move(reader)] { return reader->Next(); });
}

}  // namespace ricochet
