#include "ricochet/client.h"

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <string>
#include <utility>
#include <vector>

#include "absl/functional/function_ref.h"
#include "absl/strings/match.h"
#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/string_view.h"
#include "absl/strings/strip.h"
#include "client/answer_shape.h"
#include "client/attempts.h"
#include "client/batch_session.h"
#include "client/call_context.h"
#include "client/channel.h"
#include "client/cost_reader.h"
#include "client/final_failure.h"
#include "client/sweep_fan_out.h"
#include "client/sweep_reader.h"
#include "core/base/try.h"
#include "core/types/check_rows.h"
#include "core/types/grid.h"
#include "proto/wire/audit.h"
#include "proto/wire/batch.h"
#include "proto/wire/cost.h"
#include "proto/wire/engine.h"
#include "proto/wire/fit.h"
#include "proto/wire/info.h"
#include "proto/wire/multi_contact.h"
#include "proto/wire/requests.h"
#include "proto/wire/status.h"
#include "proto/wire/sweep.h"
#include "ricochet/error.h"
#include "ricochet/v1/impact_service.grpc.pb.h"

namespace ricochet {
namespace {

using Stub = v1::ImpactService::StubInterface;

// A unary method of the service.
template <typename WireRequest, typename WireResponse>
using Method = grpc::Status (Stub::*)(grpc::ClientContext*, const WireRequest&, WireResponse*);

// Returns the sweep with its end, or nothing if it has no points to divide or is one that a server refuses.
std::optional<SweepRequest> Divisible(const SweepRequest& request) {
  if (!ValidateAxes(request.grid).empty()) return std::nullopt;
  SweepRequest whole = request;
  const int64_t points = PointCount(request.grid);
  whole.end_index = request.end_index.value_or(points);
  const bool has_points = whole.first_index >= 0 && whole.first_index < *whole.end_index && *whole.end_index <= points;
  if (!has_points) return std::nullopt;
  return whole;
}

// Adds `first` to the places of the states that a status names.
absl::Status ShiftStates(const absl::Status& status, size_t first) {
  std::vector<Violation> violations = ViolationsOf(status);
  for (Violation& violation : violations) {
    absl::string_view rest = violation.field;
    size_t place = 0;
    if (!absl::ConsumePrefix(&rest, "states[")) continue;
    const size_t end = std::min(rest.find(']'), rest.size());
    if (!absl::SimpleAtoi(rest.substr(0, end), &place)) continue;
    violation.field = absl::StrCat("states[", place + first, rest.substr(end));
  }
  return violations.empty() ? status : WithViolations(status, violations);
}

// Asks for the states part by part, halving the parts until the server takes them.
absl::StatusOr<MultiContactResponse> AskInParts(
    const MultiContactRequest& request,
    absl::FunctionRef<absl::StatusOr<MultiContactResponse>(const MultiContactRequest&)> ask) {
  MultiContactRequest part = request;
  size_t size = request.states.size() / 2;
  MultiContactResponse whole;
  while (whole.answers.size() < request.states.size()) {
    const size_t first = whole.answers.size();
    const auto from = request.states.begin() + static_cast<std::ptrdiff_t>(first);
    const size_t count = std::min(size, request.states.size() - first);
    part.states.assign(from, from + static_cast<std::ptrdiff_t>(count));
    absl::StatusOr<MultiContactResponse> response = ask(part);
    if (ReasonOf(response.status()) == ErrorReason::kLimitExceeded && count > 1) {
      size = count / 2;
      continue;
    }
    if (!response.ok()) return ShiftStates(response.status(), first);
    if (first > 0 && response->engine.fingerprint != whole.engine.fingerprint) {
      return absl::FailedPreconditionError(absl::StrCat("the answers before states[", first, "] come from the engine ",
                                                        whole.engine.fingerprint, ", those from it on ", "from ",
                                                        response->engine.fingerprint,
                                                        ": they may differ in their last bits and must not be mixed"));
    }
    whole.engine = response->engine;
    std::move(response->answers.begin(), response->answers.end(), std::back_inserter(whole.answers));
  }
  return whole;
}

}  // namespace

struct Client::Connection {
  Connection(ClientOptions given, std::vector<std::shared_ptr<grpc::Channel>> of_servers)
      : options(std::move(given)), channels(std::move(of_servers)), preferred(channels.size()) {
    for (const auto& channel : channels) stubs.push_back(v1::ImpactService::NewStub(channel));
  }

  ClientOptions options;
  std::vector<std::shared_ptr<grpc::Channel>> channels;  // One for each server.
  std::vector<std::unique_ptr<Stub>> stubs;              // One for each server.
  PreferredServer preferred;

  // Returns the stub by which to begin the call of `context`.
  Stub& StubFor(size_t server, const grpc::ClientContext& context) const {
    AwaitReconnection(*channels[server], context.deadline());
    return *stubs[server];
  }

  // Calls `method` on one server after another until one answers.
  template <typename WireRequest, typename WireResponse>
  absl::StatusOr<WireResponse> AskWire(Method<WireRequest, WireResponse> method, const WireRequest& wire,
                                       const CallOptions& given) {
    const CallOptions call = WithDeadline(given, options.deadline);
    for (Attempts attempts(preferred, options.retry);;) {
      if (IsStopped(call)) return StoppedByCaller();
      CallContext context(call, std::nullopt);
      WireResponse response;
      const grpc::Status ended = (StubFor(attempts.server(), context.get()).*method)(&context.get(), wire, &response);
      if (ended.ok()) return response;
      if (IsStopped(call)) return StoppedByCaller();
      const absl::Status status = FromGrpcStatus(ended);
      const auto wait = attempts.AfterFailure(status, MostRetries(status));
      if (!wait.has_value() || !Pause(*wait, call)) {
        return IsStopped(call) ? StoppedByCaller() : Explain(status);
      }
    }
  }

  // Converts the request to its proto, and the response of `method` back, whose lists a caller may then index.
  template <typename Request, typename WireRequest, typename WireResponse>
  auto Ask(Method<WireRequest, WireResponse> method, const Request& request, const CallOptions& given)
      -> absl::StatusOr<decltype(FromProto(WireResponse()))> {
    RICOCHET_TRY(const WireResponse wire, AskWire(method, ToProto(request), given));
    auto response = FromProto(wire);
    if constexpr (requires { CheckShape(request, response); }) {
      if (absl::Status misshaped = CheckShape(request, response); !misshaped.ok()) return misshaped;
    }
    return response;
  }

  // Returns the final failure of a call. If gRPC has refused an answer as too large, the failure names the option that
  // sets this limit.
  absl::Status Explain(const absl::Status& error) const {
    const std::string by_this_client = absl::StrCat(" vs. ", options.max_receive_bytes, ")");
    if (!absl::IsResourceExhausted(error) || !absl::EndsWith(error.message(), by_this_client)) {
      return ExplainFailure(error);
    }
    return MakeError(error.code(), ErrorReason::kLimitExceeded,
                     absl::StrCat(error.message(),
                                  ": the answer has more bytes than ClientOptions::max_receive_bytes "
                                  "(--max-receive) allows"));
  }

  // Makes a stream of what `reader` reads, which keeps both, so that it may outlive the Client.
  template <typename Stream, typename Reader>
  static Stream StreamOf(std::shared_ptr<const Connection> connection, std::shared_ptr<Reader> reader) {
    return Stream([connection = std::move(connection), reader = std::move(reader)] {
      auto next = reader->Next();
      if (next.has_value() && !next->ok()) *next = connection->Explain(next->status());
      return next;
    });
  }

  // gRPC has already repeated a call that ends with UNAVAILABLE or CANCELLED, so that only the other servers are left.
  int MostRetries(const absl::Status& status) const {
    const auto others = static_cast<int>(stubs.size()) - 1;
    switch (status.code()) {
      case absl::StatusCode::kUnavailable:
      case absl::StatusCode::kCancelled:
        return others;
      case absl::StatusCode::kResourceExhausted:
        return IsWorthRepeating(status) ? std::max(others, options.retry.max_attempts - 1) : 0;
      default:
        return 0;
    }
  }
};

absl::StatusOr<Client> Client::Connect(const ClientOptions& options) {
  RICOCHET_TRY(auto channels, MakeChannels(options));
  return Client(std::make_shared<Connection>(options, std::move(channels)));
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

absl::StatusOr<FitResponse> Client::DoFit(const FitRequest& request, const CallOptions& options) const {
  return connection_->Ask(&Stub::Fit, request, options);
}

absl::StatusOr<MultiContactResponse> Client::DoMultiContact(const MultiContactRequest& request,
                                                            const CallOptions& options) const {
  const auto ask = [&](const MultiContactRequest& part) {
    return connection_->Ask(&Stub::MultiContact, part, options);
  };
  absl::StatusOr<MultiContactResponse> response = ask(request);
  const bool is_too_large = ReasonOf(response.status()) == ErrorReason::kLimitExceeded && request.states.size() > 1;
  return is_too_large ? AskInParts(request, ask) : response;
}

absl::StatusOr<BatchSession> Client::DoOpenBatches(const BatchSetup& setup, const CallOptions& options) const {
  auto start = [connection = connection_](size_t server, grpc::ClientContext* context) {
    return connection->StubFor(server, *context).SolveBatches(context);
  };
  auto ask_most_rows = [connection = connection_, setup, options]() -> absl::StatusOr<size_t> {
    RICOCHET_TRY(const InfoResponse info, connection->Ask(&Stub::Info, InfoRequest(), options));
    return RowsOfAPiece(setup, info.limits);
  };
  const ClientOptions& own = connection_->options;
  return BatchSession(std::make_unique<RemoteBatches>(setup, std::move(start), std::move(ask_most_rows),
                                                      connection_->preferred, own.retry, own.max_receive_bytes,
                                                      options));
}

absl::StatusOr<BatchResponse> Client::DoSolveBatch(const BatchSetup& setup, const BatchRows& rows,
                                                   const CallOptions& options) const {
  const size_t count = RowCount(rows);
  if (count > RowsOfAPiece(setup, connection_->options.max_receive_bytes)) return SolveInPieces(setup, rows, options);
  if (absl::Status misfit = CheckRows(rows, setup.fields.size(), setup.columns.size()); !misfit.ok()) return misfit;
  v1::SolveBatchRequest request;
  *request.mutable_setup() = ToProto(setup);
  SetInputs(rows, 0, count, request);
  const absl::StatusOr<v1::SolveBatchResponse> response = connection_->AskWire(&Stub::SolveBatch, request, options);
  if (count > 1 && ReasonOf(response.status()) == ErrorReason::kLimitExceeded) {
    return SolveInPieces(setup, rows, options);
  }
  if (!response.ok()) return response.status();
  if (absl::Status misfit = CopyOutputs(*response, 0, count, rows); !misfit.ok()) return misfit;
  return BatchResponse{.summary = FromProto(response->summary()), .engine = FromProto(response->engine())};
}

absl::StatusOr<BatchResponse> Client::SolveInPieces(const BatchSetup& setup, const BatchRows& rows,
                                                    const CallOptions& options) const {
  RICOCHET_TRY(BatchSession session, DoOpenBatches(setup, WithDeadline(options, connection_->options.sweep_deadline)));
  RICOCHET_TRY(BatchSummary summary, session.Solve(rows));
  return BatchResponse{.summary = std::move(summary), .engine = session.engine()};
}

SweepStream Client::DoSweep(const SweepRequest& request, const CallOptions& options) const {
  auto start = [connection = connection_](size_t server, grpc::ClientContext* context, const v1::SweepRequest& part) {
    return connection->StubFor(server, *context).Sweep(context, part);
  };
  const ClientOptions& given = connection_->options;
  const size_t servers = connection_->stubs.size();
  if (std::optional<SweepRequest> whole = Divisible(request);
      given.fan_out.has_value() && servers > 1 && whole.has_value()) {
    auto reader = std::make_shared<SweepFanOut>(
        *std::move(whole),
        SweepFanOut::Servers{
            .start = std::move(start), .count = servers, .retry = given.retry, .fan_out = *given.fan_out},
        WithDeadline(options, given.sweep_deadline));
    return Connection::StreamOf<SweepStream>(connection_, std::move(reader));
  }
  auto reader = std::make_shared<SweepReader>(request, std::move(start), connection_->preferred, given.retry,
                                              given.sweep_deadline, options);
  return Connection::StreamOf<SweepStream>(connection_, std::move(reader));
}

CostStream Client::DoCost(const CostRequest& request, const CallOptions& options) const {
  auto reader = std::make_shared<CostReader>(
      [&](grpc::ClientContext* context) {
        return connection_->StubFor(connection_->preferred.get(), *context).Cost(context, ToProto(request));
      },
      connection_->options.sweep_deadline, options);
  return Connection::StreamOf<CostStream>(connection_, std::move(reader));
}

absl::StatusOr<InfoResponse> Client::DoInfo(const InfoRequest& request, const CallOptions& options) const {
  return connection_->Ask(&Stub::Info, request, options);
}

}  // namespace ricochet
