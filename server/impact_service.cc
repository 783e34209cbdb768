#include "server/impact_service.h"

#include <chrono>
#include <utility>

#include "absl/strings/str_cat.h"
#include "core/engine/engine.h"
#include "core/engine/local_solver.h"
#include "core/sweep/sweep_run.h"
#include "proto/wire/audit.h"
#include "proto/wire/engine.h"
#include "proto/wire/outcome.h"
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

// Why a call that was stopped, or whose chunk could not be sent, ends.
absl::Status WhyStopped(const grpc::ServerContext& context, bool draining) {
  if (context.deadline() <= std::chrono::system_clock::now()) {
    return absl::DeadlineExceededError("the call's deadline passed");
  }
  if (draining) return Draining();
  return absl::CancelledError("the client cancelled the call or went away");
}

}  // namespace

ImpactService::ImpactService(const Solver& solver, int64_t max_points_per_sweep, std::stop_token drain,
                             Admission& admission, const Log& log)
    : solver_(solver),
      max_points_per_sweep_(max_points_per_sweep),
      drain_(std::move(drain)),
      admission_(admission),
      log_(log) {}

grpc::Status ImpactService::Solve(grpc::ServerContext* context, const v1::SolveRequest* request,
                                  v1::SolveResponse* response) {
  Call call("Solve", *context, admission_, log_);
  if (!call.admitted().ok()) return call.Finish(call.admitted());
  const absl::StatusOr<SolveResponse> answer = solver_.Solve(FromProto(*request));
  if (answer.ok()) *response = ToProto(*answer);
  return call.Finish(answer.status());
}

grpc::Status ImpactService::Bounds(grpc::ServerContext* context, const v1::BoundsRequest* request,
                                   v1::BoundsResponse* response) {
  Call call("Bounds", *context, admission_, log_);
  if (!call.admitted().ok()) return call.Finish(call.admitted());
  const absl::StatusOr<BoundsResponse> answer =
      AnswerBounds(FromProto(*request), [context] { return context->IsCancelled(); });
  if (answer.ok()) *response = ToProto(*answer);
  return call.Finish(absl::IsCancelled(answer.status()) ? WhyStopped(*context, false) : answer.status());
}

grpc::Status ImpactService::Audit(grpc::ServerContext* context, const v1::AuditRequest* request,
                                  v1::AuditResponse* response) {
  Call call("Audit", *context, admission_, log_);
  if (!call.admitted().ok()) return call.Finish(call.admitted());
  const absl::StatusOr<AuditResponse> answer = solver_.Audit(FromProto(*request));
  if (answer.ok()) *response = ToProto(*answer);
  return call.Finish(answer.status());
}

grpc::Status ImpactService::AuditBatch(grpc::ServerContext* context, const v1::AuditBatchRequest* request,
                                       v1::AuditBatchResponse* response) {
  Call call("AuditBatch", *context, admission_, log_);
  if (!call.admitted().ok()) return call.Finish(call.admitted());
  const absl::StatusOr<AuditBatchResponse> answer = solver_.AuditBatch(FromProto(*request));
  if (answer.ok()) *response = ToProto(*answer);
  return call.Finish(answer.status());
}

grpc::Status ImpactService::Sweep(grpc::ServerContext* context, const v1::SweepRequest* request,
                                  grpc::ServerWriter<v1::SweepResponse>* writer) {
  Call call("Sweep", *context, admission_, log_);
  if (!call.admitted().ok()) return call.Finish(call.admitted());
  return call.Finish(StreamSweep(FromProto(*request), *context, *writer, call));
}

absl::Status ImpactService::StreamSweep(const SweepRequest& request, const grpc::ServerContext& context,
                                        grpc::ServerWriter<v1::SweepResponse>& writer, Call& call) const {
  absl::StatusOr<SweepRun> run = SweepRun::Make(request);
  if (!run.ok()) return run.status();
  if (run->points_total() > max_points_per_sweep_) {
    return SweepTooLarge(run->points_total(), max_points_per_sweep_);
  }
  const auto stopped = [&] { return drain_.stop_requested() || context.IsCancelled(); };
  v1::SweepResponse response;
  while (!run->ended()) {
    absl::StatusOr<SweepChunk> chunk = run->NextChunk(stopped);
    call.set_points(run->points_done());
    if (!chunk.ok()) return WhyStopped(context, drain_.stop_requested());
    chunk->engine = ThisEngine();
    if (chunk->summary.has_value()) chunk->summary->elapsed_s = call.elapsed_s();
    ToProto(*chunk, response);
    grpc::WriteOptions options;
    if (run->ended()) options.set_last_message();
    if (!writer.Write(response, options)) return WhyStopped(context, drain_.stop_requested());
  }
  return absl::OkStatus();
}

}  // namespace ricochet::server
