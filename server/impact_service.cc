#include "server/impact_service.h"

#include <chrono>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/types/span.h"
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

// Computes the next chunk into `response`, whose memory is reused. Returns false if it was stopped.
bool NextChunk(SweepRun& run, absl::FunctionRef<bool()> stopped, std::vector<Regime>& regimes,
               v1::SweepResponse& response) {
  const SweepRun::Extent extent = run.Next();
  auto& values = *response.mutable_values();
  values.Resize(static_cast<int>(extent.count * run.column_count()), 0.0);
  if (!regimes.empty()) regimes.resize(static_cast<size_t>(extent.count));
  if (!run.Compute(extent, absl::MakeSpan(values.mutable_data(), static_cast<size_t>(values.size())),
                   absl::MakeSpan(regimes), stopped)) {
    return false;
  }
  response.set_first_index(extent.first_index);
  response.set_count(extent.count);
  response.set_points_done(run.points_done());
  response.set_points_total(run.points_total());
  response.clear_regimes();
  for (const Regime regime : regimes) response.add_regimes(ToProto(regime));
  return true;
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
  *response.mutable_engine() = ToProto(ThisEngine());
  std::vector<Regime> regimes(request.with_regime ? 1 : 0);
  do {
    const bool computed = NextChunk(*run, stopped, regimes, response);
    call.set_points(run->points_done());
    if (!computed) return WhyStopped(context, drain_.stop_requested());
    grpc::WriteOptions options;
    if (run->done()) {
      *response.mutable_summary() = ToProto(run->summary());
      response.mutable_summary()->set_elapsed_s(call.elapsed_s());
      options.set_last_message();
    }
    if (!writer.Write(response, options)) return WhyStopped(context, drain_.stop_requested());
  } while (!run->done());
  return absl::OkStatus();
}

}  // namespace ricochet::server
