#include "server/calls/impact_service.h"

#include <functional>
#include <optional>
#include <utility>

#include "absl/functional/function_ref.h"
#include "proto/wire/audit.h"
#include "proto/wire/chunk_seal.h"
#include "proto/wire/cost.h"
#include "proto/wire/fit.h"
#include "proto/wire/info.h"
#include "proto/wire/multi_contact.h"
#include "proto/wire/requests.h"
#include "proto/wire/sweep.h"
#include "ricochet/result_stream.h"
#include "server/admission/request_cost.h"
#include "server/calls/batch_answer.h"

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

// Reads a stream of the solver to its end, each element when it is the call's turn to compute. `prepare` turns an
// element into a message, `send` sends the message.
template <typename T>
absl::Status ForwardStream(Call& call, absl::FunctionRef<ResultStream<T>()> open, absl::FunctionRef<void(T&)> prepare,
                           absl::FunctionRef<absl::Status()> send) {
  std::optional<ResultStream<T>> stream;
  typename ResultStream<T>::Iterator at;
  for (;;) {
    bool is_last = false;
    absl::Status computed = call.Compute(std::nullopt, [&] {
      if (stream.has_value()) {
        ++at;
      } else {
        stream.emplace(open());
        at = stream->begin();
      }
      is_last = at == stream->end() || (at->ok() && (*at)->summary.has_value());
      if (at == stream->end()) return absl::OkStatus();
      if (at->ok()) prepare(**at);
      return at->status();
    });
    if (!computed.ok() || at == stream->end()) return computed;
    if (absl::Status sent = send(); !sent.ok() || is_last) return sent;
  }
}

// Sends one message of a stream; the one with the summary is the last.
template <typename Response>
absl::Status Send(const Response& response, grpc::ServerWriter<Response>& writer, Call& call) {
  grpc::WriteOptions last;
  if (response.has_summary()) last.set_last_message();
  const auto bytes = static_cast<int64_t>(response.ByteSizeLong());
  ++call.record().chunks;
  call.record().chunk_bytes += bytes;
  call.record().sent_bytes += bytes;
  return call.Send([&] { return writer.Write(response, last); });
}

}  // namespace

ImpactService::ImpactService(const Solver& solver, CallFrame frame, ServerLimits limits)
    : solver_(solver), frame_(std::move(frame)), limits_(limits) {}

template <typename Request, typename Response, typename Method>
grpc::Status ImpactService::Answer(const char* name, Method method, grpc::ServerContext& context,
                                   const Request& request, Response& response) const {
  Call call(name, Call::Kind::kUnary, context, frame_);
  if (absl::Status refused = call.admitted(); !refused.ok()) return call.Finish(refused);
  call.record().received_bytes = static_cast<int64_t>(request.ByteSizeLong());
  const auto asked = FromProto(request);
  return call.Finish(call.Compute(CostOf(asked), [&] {
    const auto answer = std::invoke(method, solver_, asked, call.options());
    if (!answer.ok()) return answer.status();
    CountModel(*answer, call.record());
    response = ToProto(*answer);
    call.record().sent_bytes = static_cast<int64_t>(response.ByteSizeLong());
    return call.HoldAnswer(call.record().sent_bytes);
  }));
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

grpc::Status ImpactService::MultiContact(grpc::ServerContext* context, const v1::MultiContactRequest* request,
                                         v1::MultiContactResponse* response) {
  return Answer("MultiContact", &Solver::MultiContact, *context, *request, *response);
}

grpc::Status ImpactService::Fit(grpc::ServerContext* context, const v1::FitRequest* request,
                                v1::FitResponse* response) {
  return Answer("Fit", &Solver::Fit, *context, *request, *response);
}

grpc::Status ImpactService::Sweep(grpc::ServerContext* context, const v1::SweepRequest* request,
                                  grpc::ServerWriter<v1::SweepResponse>* writer) {
  Call call("Sweep", Call::Kind::kStream, *context, frame_);
  if (absl::Status refused = call.admitted(); !refused.ok()) return call.Finish(refused);
  call.record().received_bytes = static_cast<int64_t>(request->ByteSizeLong());
  return call.Finish(Stream(FromProto(*request), *writer, call));
}

grpc::Status ImpactService::Cost(grpc::ServerContext* context, const v1::CostRequest* request,
                                 grpc::ServerWriter<v1::CostResponse>* writer) {
  Call call("Cost", Call::Kind::kStream, *context, frame_);
  if (absl::Status refused = call.admitted(); !refused.ok()) return call.Finish(refused);
  call.record().received_bytes = static_cast<int64_t>(request->ByteSizeLong());
  return call.Finish(Stream(FromProto(*request), *writer, call));
}

grpc::Status ImpactService::SolveBatch(grpc::ServerContext* context, const v1::SolveBatchRequest* request,
                                       v1::SolveBatchResponse* response) {
  Call call("SolveBatch", Call::Kind::kUnary, *context, frame_);
  if (absl::Status refused = call.admitted(); !refused.ok()) return call.Finish(refused);
  call.record().received_bytes = static_cast<int64_t>(request->ByteSizeLong());
  BatchAnswer answer(solver_, call.options());
  return call.Finish(call.Compute(answer.CostOf(*request), [&] {
    absl::Status filled = answer.Fill(*request, *response, call.record());
    call.record().sent_bytes = static_cast<int64_t>(response->ByteSizeLong());
    return filled.ok() ? call.HoldAnswer(call.record().sent_bytes) : filled;
  }));
}

grpc::Status ImpactService::AnswerBatches(grpc::ServerContext& context, BoundedBatches& batches) const {
  Call call("SolveBatches", Call::Kind::kStream, context, frame_);
  if (absl::Status refused = call.admitted(); !refused.ok()) return call.Finish(refused);
  return call.Finish(Answer(batches, call));
}

absl::Status ImpactService::Answer(BoundedBatches& batches, Call& call) const {
  BatchAnswer answer(solver_, call.options());
  for (;;) {
    const absl::StatusOr<bool> received = call.Receive([&] { return batches.Receive(); });
    if (!received.ok()) return received.status();
    if (!*received) return absl::OkStatus();
    call.record().received_bytes += batches.received_bytes();
    // The messages live for one batch only, so that a stream which waits for its caller holds no memory.
    const absl::StatusOr<Parsed<v1::SolveBatchRequest>> request = batches.Parse();
    if (!request.ok()) return request.status();
    v1::SolveBatchResponse response;
    // A step of a simulation is short and answered at once; a long batch takes its turn among the parts of streams.
    const RequestCost cost = answer.CostOf(request->message);
    absl::Status filled = call.Compute(cost.is_cheap() ? std::optional(cost) : std::nullopt,
                                       [&] { return answer.Fill(request->message, response, call.record()); });
    if (!filled.ok()) return filled;
    const auto bytes = static_cast<int64_t>(response.ByteSizeLong());
    ++call.record().chunks;
    call.record().chunk_bytes += bytes;
    call.record().sent_bytes += bytes;
    // A stream keeps the message beside its bytes until they are sent.
    if (absl::Status held = call.HoldAnswer(2 * bytes); !held.ok()) return held;
    if (absl::Status sent = call.Send([&] { return batches.Write(response); }); !sent.ok()) return sent;
  }
}

grpc::Status ImpactService::Info(grpc::ServerContext* context, const v1::InfoRequest* request,
                                 v1::InfoResponse* response) {
  const auto info = [this](const Solver& solver, const InfoRequest& asked, const CallOptions& options) {
    absl::StatusOr<InfoResponse> answer = solver.Info(asked, options);
    if (answer.ok()) answer->server_limits = limits_;
    return answer;
  };
  return Answer("Info", info, *context, *request, *response);
}

absl::Status ImpactService::Stream(const SweepRequest& request, grpc::ServerWriter<v1::SweepResponse>& writer,
                                   Call& call) const {
  const ChunkSeal seal(request);
  v1::SweepResponse response;
  call.record().first_index = request.first_index;
  const auto prepare = [&](SweepChunk& chunk) {
    call.record().points = chunk.points_done;
    if (chunk.summary.has_value()) {
      CountModels(*chunk.summary, call.record());
      chunk.summary->elapsed_s = call.elapsed_s();
    }
    // A message keeps the room of the largest chunk that it had, which a caller who has become slow need not hold.
    if (response.values().capacity() > 2 * sizeof(double) * chunk.values.size()) response = {};
    ToProto(chunk, response);
    seal.Put(response);
  };
  return ForwardStream<SweepChunk>(
      call, [&] { return solver_.Sweep(request, call.options()); }, prepare,
      [&] { return Send(response, writer, call); });
}

absl::Status ImpactService::Stream(const CostRequest& request, grpc::ServerWriter<v1::CostResponse>& writer,
                                   Call& call) const {
  v1::CostResponse response;
  const auto prepare = [&](const CostChunk& chunk) { response = ToProto(chunk); };
  return ForwardStream<CostChunk>(
      call, [&] { return solver_.Cost(request, call.options()); }, prepare,
      [&] { return Send(response, writer, call); });
}

}  // namespace ricochet::server
