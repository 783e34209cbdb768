#include "server/impact_service.h"

#include <utility>

#include "proto/wire/audit.h"
#include "proto/wire/chunk_seal.h"
#include "proto/wire/cost.h"
#include "proto/wire/requests.h"
#include "proto/wire/sweep.h"
#include "server/refusals.h"

namespace ricochet::server {
namespace {

void CountModel(const SolveResponse& answer, CallRecord& record) {
  ++record.solved_by_model.at(static_cast<size_t>(answer.outcome.plan.model));
}
template <typename Answer>
void CountModel(const Answer& /*answer*/, CallRecord& /*record*/) {}

void CountModels(const SweepSummary& summary, CallRecord& record) {
  for (size_t i = 0; i < summary.by_model.size(); ++i) record.solved_by_model[i] = summary.by_model[i].count;
}

// Sends one message of a stream; the one with the summary is the last.
template <typename Response>
absl::Status Write(const Response& response, grpc::ServerWriter<Response>& writer, CallRecord& record) {
  grpc::WriteOptions last;
  if (response.has_summary()) last.set_last_message();
  ++record.chunks;
  record.chunk_bytes += static_cast<int64_t>(response.ByteSizeLong());
  if (writer.Write(response, last)) return absl::OkStatus();
  return absl::CancelledError("the client cancelled the call or went away");
}

// Returns the options of a call that also ends when the drain asks for it.
CallOptions EndingWith(std::stop_token drain, const Call& call) {
  CallOptions options = call.options();
  options.stop = std::move(drain);
  return options;
}

// Returns the error for a status that draining has caused.
absl::Status OrDraining(const absl::Status& status, const std::stop_token& drain) {
  return absl::IsCancelled(status) && drain.stop_requested() ? Draining() : status;
}

}  // namespace

ImpactService::ImpactService(const Solver& solver, DrainStops drain, Admission& admission, const Observer& observer)
    : solver_(solver), drain_(std::move(drain)), admission_(admission), observer_(observer) {}

template <typename Request, typename Response, typename Method>
grpc::Status ImpactService::Answer(const char* name, Method method, grpc::ServerContext& context,
                                   const Request& request, Response& response) const {
  Call call(name, context, admission_, observer_);
  if (!call.admitted().ok()) return call.Finish(call.admitted());
  if (drain_.streams.stop_requested()) return call.Finish(Draining());
  const auto answer = (solver_.*method)(FromProto(request), EndingWith(drain_.unary, call));
  if (answer.ok()) {
    CountModel(*answer, call.record());
    response = ToProto(*answer);
  }
  return call.Finish(OrDraining(answer.status(), drain_.unary));
}

grpc::Status ImpactService::Solve(grpc::ServerContext* context, const v1::SolveRequest* request,
                                  v1::SolveResponse* response) {
  return Answer("Solve", &Solver::Solve, *context, *request, *response);
}

grpc::Status ImpactService::Plan(grpc::ServerContext* context, const v1::PlanRequest* request,
                                 v1::PlanResponse* response) {
  return Answer("Plan", &Solver::Plan, *context, *request, *response);
}

grpc::Status ImpactService::Bounds(grpc::ServerContext* context, const v1::BoundsRequest* request,
                                   v1::BoundsResponse* response) {
  return Answer("Bounds", &Solver::Bounds, *context, *request, *response);
}

grpc::Status ImpactService::Audit(grpc::ServerContext* context, const v1::AuditRequest* request,
                                  v1::AuditResponse* response) {
  return Answer("Audit", &Solver::Audit, *context, *request, *response);
}

grpc::Status ImpactService::AuditBatch(grpc::ServerContext* context, const v1::AuditBatchRequest* request,
                                       v1::AuditBatchResponse* response) {
  return Answer("AuditBatch", &Solver::AuditBatch, *context, *request, *response);
}

grpc::Status ImpactService::Sweep(grpc::ServerContext* context, const v1::SweepRequest* request,
                                  grpc::ServerWriter<v1::SweepResponse>* writer) {
  Call call("Sweep", *context, admission_, observer_);
  if (!call.admitted().ok()) return call.Finish(call.admitted());
  return call.Finish(OrDraining(Stream(FromProto(*request), *writer, call), drain_.streams));
}

grpc::Status ImpactService::Cost(grpc::ServerContext* context, const v1::CostRequest* request,
                                 grpc::ServerWriter<v1::CostResponse>* writer) {
  Call call("Cost", *context, admission_, observer_);
  if (!call.admitted().ok()) return call.Finish(call.admitted());
  return call.Finish(OrDraining(Stream(FromProto(*request), *writer, call), drain_.streams));
}

absl::Status ImpactService::Stream(const SweepRequest& request, grpc::ServerWriter<v1::SweepResponse>& writer,
                                   Call& call) const {
  const ChunkSeal seal(request);
  v1::SweepResponse response;
  call.record().first_index = request.first_index;
  for (absl::StatusOr<SweepChunk>& chunk : solver_.Sweep(request, EndingWith(drain_.streams, call))) {
    if (!chunk.ok()) return chunk.status();
    call.record().points = chunk->points_done;
    if (chunk->summary.has_value()) {
      CountModels(*chunk->summary, call.record());
      chunk->summary->elapsed_s = call.elapsed_s();
    }
    ToProto(*chunk, response);
    seal.Put(response);
    if (absl::Status written = Write(response, writer, call.record()); !written.ok()) return written;
  }
  return absl::OkStatus();
}

absl::Status ImpactService::Stream(const CostRequest& request, grpc::ServerWriter<v1::CostResponse>& writer,
                                   Call& call) const {
  for (const absl::StatusOr<CostChunk>& chunk : solver_.Cost(request, EndingWith(drain_.streams, call))) {
    if (!chunk.ok()) return chunk.status();
    if (absl::Status written = Write(ToProto(*chunk), writer, call.record()); !written.ok()) return written;
  }
  return absl::OkStatus();
}

}  // namespace ricochet::server
