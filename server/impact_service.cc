#include "server/impact_service.h"

#include <chrono>
#include <utility>

#include "absl/strings/str_cat.h"
#include "proto/wire/audit.h"
#include "proto/wire/requests.h"
#include "proto/wire/sweep.h"
#include "ricochet/error.h"

namespace ricochet::server {
namespace {

absl::Status SweepTooLarge(int64_t points, int64_t limit) {
  absl::Status status = MakeError(absl::StatusCode::kResourceExhausted, ErrorReason::kSweepTooLarge,
                                  absl::StrCat("the sweep has ", points, " points, this server computes at most ",
                                               limit, " in one call; ask for sub-ranges by first_index and end_index"));
  SetRetryDelay(std::chrono::milliseconds(0), status);
  return status;
}

absl::Status Draining() {
  absl::Status status = MakeError(absl::StatusCode::kUnavailable, ErrorReason::kDraining,
                                  "the server is shutting down; ask again from the first point not received");
  SetRetryDelay(std::chrono::seconds(1), status);
  return status;
}

}  // namespace

ImpactService::ImpactService(const Solver& solver, int64_t max_points_per_sweep, std::stop_token drain,
                             Admission& admission, const Log& log)
    : solver_(solver),
      max_points_per_sweep_(max_points_per_sweep),
      drain_(std::move(drain)),
      admission_(admission),
      log_(log) {}

template <typename Request, typename Response, typename Method>
grpc::Status ImpactService::Answer(const char* name, Method method, const grpc::ServerContext& context,
                                   const Request& request, Response& response) const {
  Call call(name, context, admission_, log_);
  if (!call.admitted().ok()) return call.Finish(call.admitted());
  const auto answer = (solver_.*method)(FromProto(request), call.options());
  if (answer.ok()) response = ToProto(*answer);
  return call.Finish(answer.status());
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
  Call call("Sweep", *context, admission_, log_);
  if (!call.admitted().ok()) return call.Finish(call.admitted());
  const absl::Status status = Stream(FromProto(*request), *writer, call);
  return call.Finish(absl::IsCancelled(status) && drain_.stop_requested() ? Draining() : status);
}

absl::Status ImpactService::Stream(const SweepRequest& request, grpc::ServerWriter<v1::SweepResponse>& writer,
                                   Call& call) const {
  CallOptions options = call.options();
  options.stop = drain_;
  v1::SweepResponse response;
  for (absl::StatusOr<SweepChunk>& chunk : solver_.Sweep(request, options)) {
    if (!chunk.ok()) return chunk.status();
    if (chunk->points_total > max_points_per_sweep_) return SweepTooLarge(chunk->points_total, max_points_per_sweep_);
    call.set_points(chunk->points_done);
    if (chunk->summary.has_value()) chunk->summary->elapsed_s = call.elapsed_s();
    ToProto(*chunk, response);
    grpc::WriteOptions last;
    if (response.has_summary()) last.set_last_message();
    if (!writer.Write(response, last)) return absl::CancelledError("the client cancelled the call or went away");
  }
  return absl::OkStatus();
}

}  // namespace ricochet::server
