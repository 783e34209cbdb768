// ImpactService: the handlers of ricochet.v1.ImpactService. Each converts the request, calls the Solver, and converts
// the response and the status.

#ifndef RICOCHET_SERVER_CALLS_IMPACT_SERVICE_H_
#define RICOCHET_SERVER_CALLS_IMPACT_SERVICE_H_

#include <grpcpp/server_context.h>
#include <grpcpp/support/status.h>
#include <grpcpp/support/sync_stream.h>

#include "ricochet/solver.h"
#include "ricochet/v1/impact_service.grpc.pb.h"
#include "server/calls/bounded_service.h"
#include "server/calls/call.h"

namespace ricochet::server {

// Thread safety: gRPC calls every handler from several threads at once.
class ImpactService final : public v1::ImpactService::Service {
 public:
  // `solver` and all that `frame` refers to must outlive the service. Info answers `limits`.
  ImpactService(const Solver& solver, CallFrame frame, ServerLimits limits);

  grpc::Status Solve(grpc::ServerContext* context, const v1::SolveRequest* request,
                     v1::SolveResponse* response) override;
  grpc::Status Plan(grpc::ServerContext* context, const v1::PlanRequest* request, v1::PlanResponse* response) override;
  grpc::Status Bounds(grpc::ServerContext* context, const v1::BoundsRequest* request,
                      v1::BoundsResponse* response) override;
  grpc::Status Audit(grpc::ServerContext* context, const v1::AuditRequest* request,
                     v1::AuditResponse* response) override;
  grpc::Status AuditBatch(grpc::ServerContext* context, const v1::AuditBatchRequest* request,
                          v1::AuditBatchResponse* response) override;
  grpc::Status MultiContact(grpc::ServerContext* context, const v1::MultiContactRequest* request,
                            v1::MultiContactResponse* response) override;
  grpc::Status Fit(grpc::ServerContext* context, const v1::FitRequest* request, v1::FitResponse* response) override;
  grpc::Status Sweep(grpc::ServerContext* context, const v1::SweepRequest* request,
                     grpc::ServerWriter<v1::SweepResponse>* writer) override;
  grpc::Status Cost(grpc::ServerContext* context, const v1::CostRequest* request,
                    grpc::ServerWriter<v1::CostResponse>* writer) override;
  grpc::Status SolveBatch(grpc::ServerContext* context, const v1::SolveBatchRequest* request,
                          v1::SolveBatchResponse* response) override;

  // Handles a stream of batches, whose requests are bounded one by one (server/calls/bounded_service.h).
  grpc::Status AnswerBatches(grpc::ServerContext& context, BoundedBatches& batches) const;
  grpc::Status Info(grpc::ServerContext* context, const v1::InfoRequest* request, v1::InfoResponse* response) override;

 private:
  // Handles a unary call: converts the request, calls `method` with the solver, the request and the options of the
  // call, converts the answer.
  template <typename Request, typename Response, typename Method>
  grpc::Status Answer(const char* name, Method method, grpc::ServerContext& context, const Request& request,
                      Response& response) const;

  // Answers every batch of a stream.
  absl::Status Answer(BoundedBatches& batches, Call& call) const;
  // Sends every chunk of a sweep.
  absl::Status Stream(const SweepRequest& request, grpc::ServerWriter<v1::SweepResponse>& writer, Call& call) const;
  // Sends every part of a study of cost.
  absl::Status Stream(const CostRequest& request, grpc::ServerWriter<v1::CostResponse>& writer, Call& call) const;

  const Solver& solver_;
  const CallFrame frame_;
  const ServerLimits limits_;
};

}  // namespace ricochet::server

#endif  // RICOCHET_SERVER_CALLS_IMPACT_SERVICE_H_
