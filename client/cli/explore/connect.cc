#include "client/cli/explore/connect.h"

#include <google/protobuf/util/json_util.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdint>
#include <functional>
#include <string>
#include <utility>

#include "absl/strings/ascii.h"
#include "absl/strings/escaping.h"
#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/strip.h"
#include "client/cli/input/scene_input.h"
#include "client/cli/text/json_text.h"
#include "google/rpc/error_details.pb.h"
#include "google/rpc/status.pb.h"
#include "proto/wire/audit.h"
#include "proto/wire/batch.h"
#include "proto/wire/cost.h"
#include "proto/wire/info.h"
#include "proto/wire/requests.h"
#include "proto/wire/status.h"

namespace ricochet::cli {
namespace {

constexpr char kService[] = "/ricochet.v1.ImpactService/";
constexpr char kJson[] = "application/json";
constexpr char kJsonStream[] = "application/connect+json";
constexpr std::chrono::milliseconds kLongest = std::chrono::minutes(1);

// --- Errors ---

struct Code {
  const char* name;
  int http;
};

Code CodeOf(absl::StatusCode code) {
  switch (code) {
    case absl::StatusCode::kOk:
    case absl::StatusCode::kDoNotUseReservedForFutureExpansionUseDefaultInSwitchInstead_:
    case absl::StatusCode::kUnknown:
      break;
    case absl::StatusCode::kCancelled:
      return {"canceled", 499};
    case absl::StatusCode::kInvalidArgument:
      return {"invalid_argument", 400};
    case absl::StatusCode::kDeadlineExceeded:
      return {"deadline_exceeded", 504};
    case absl::StatusCode::kNotFound:
      return {"not_found", 404};
    case absl::StatusCode::kAlreadyExists:
      return {"already_exists", 409};
    case absl::StatusCode::kPermissionDenied:
      return {"permission_denied", 403};
    case absl::StatusCode::kResourceExhausted:
      return {"resource_exhausted", 429};
    case absl::StatusCode::kFailedPrecondition:
      return {"failed_precondition", 400};
    case absl::StatusCode::kAborted:
      return {"aborted", 409};
    case absl::StatusCode::kOutOfRange:
      return {"out_of_range", 400};
    case absl::StatusCode::kUnimplemented:
      return {"unimplemented", 501};
    case absl::StatusCode::kInternal:
      return {"internal", 500};
    case absl::StatusCode::kUnavailable:
      return {"unavailable", 503};
    case absl::StatusCode::kDataLoss:
      return {"data_loss", 500};
    case absl::StatusCode::kUnauthenticated:
      return {"unauthenticated", 401};
  }
  return {"unknown", 500};
}

// Returns a detail: its bytes in base64 without padding, and the same in JSON for people and for pages.
template <typename Detail>
std::string DetailText(const google::protobuf::Any& any) {
  Detail detail;
  std::string json;
  if (!any.UnpackTo(&detail) || !google::protobuf::util::MessageToJsonString(detail, &json).ok()) return "";
  std::string bytes = absl::Base64Escape(any.value());
  bytes.erase(bytes.find_last_not_of('=') + 1);
  return absl::StrCat("{\"type\":\"", Detail::descriptor()->full_name(), "\",\"value\":\"", bytes, "\",\"debug\":", json,
                      "}");
}

std::string DetailsText(const std::string& bytes) {
  google::rpc::Status proto;
  proto.ParseFromString(bytes);
  std::string text;
  for (const google::protobuf::Any& any : proto.details()) {
    for (const std::string& detail :
         {DetailText<google::rpc::ErrorInfo>(any), DetailText<google::rpc::BadRequest>(any),
          DetailText<google::rpc::RetryInfo>(any)}) {
      if (!detail.empty()) absl::StrAppend(&text, text.empty() ? "" : ",", detail);
    }
  }
  return text;
}

std::string ErrorText(const absl::Status& status) {
  const grpc::Status sent = ToGrpcStatus(status);
  std::string text = absl::StrCat("{\"code\":\"", CodeOf(status.code()).name, "\",\"message\":");
  AppendJson(sent.error_message(), text);
  const std::string details = DetailsText(sent.error_details());
  if (!details.empty()) absl::StrAppend(&text, ",\"details\":[", details, "]");
  return text + "}";
}

void ReplyError(int http, const absl::Status& status, Exchange& exchange, absl::string_view headers = "") {
  exchange.Reply(http, kJson, ErrorText(status), headers);
}

// --- Calls of one answer ---

// The JSON text of the answer to a request in JSON.
using Answer = absl::StatusOr<std::string>;

// `method` is that of the Solver, whose request is that of the proto.
template <typename ProtoRequest, auto method>
Answer AnswerUnary(const Solver& solver, const std::string& body, const CallOptions& options) {
  ProtoRequest request;
  if (absl::Status wrong = ParseJson("the body", body, request); !wrong.ok()) return wrong;
  const auto answer = std::invoke(method, solver, FromProto(request), options);
  if (!answer.ok()) return answer.status();
  return JsonOf(ToProto(*answer));
}

Answer AnswerBatch(const Solver& solver, const std::string& body, const CallOptions& options) {
  v1::SolveBatchRequest request;
  if (absl::Status wrong = ParseJson("the body", body, request); !wrong.ok()) return wrong;
  const BatchSetup setup = FromProto(request.setup());
  absl::StatusOr<BatchSession> session = solver.OpenBatches(setup, options);
  if (!session.ok()) return session.status();
  v1::SolveBatchResponse response;
  const absl::StatusOr<BatchSummary> summary =
      BatchExchange().Answer(*session, setup.columns.size(), request, response);
  if (!summary.ok()) return summary.status();
  return JsonOf(response);
}

struct Method {
  const char* name;
  Answer (*answer)(const Solver&, const std::string&, const CallOptions&);
};

constexpr std::array kMethods = {
    Method{"Solve", &AnswerUnary<v1::SolveRequest, &Solver::Solve>},
    Method{"Plan", &AnswerUnary<v1::PlanRequest, &Solver::Plan>},
    Method{"Bounds", &AnswerUnary<v1::BoundsRequest, &Solver::Bounds>},
    Method{"Audit", &AnswerUnary<v1::AuditRequest, &Solver::Audit>},
    Method{"AuditBatch", &AnswerUnary<v1::AuditBatchRequest, &Solver::AuditBatch>},
    Method{"SolveBatch", &AnswerBatch},
    Method{"Info", &AnswerUnary<v1::InfoRequest, &Solver::Info>}};

// --- The stream of a study of cost ---

// In a stream each message has a byte of flags and four of its length in front.
constexpr size_t kPrefix = 5;
constexpr char kLast = 2;

std::string Enveloped(char flags, const std::string& text) {
  std::string prefix(1, flags);
  for (int shift = 24; shift >= 0; shift -= 8) prefix.push_back(static_cast<char>(text.size() >> shift));
  return prefix + text;
}

// Returns the one message of the request.
absl::StatusOr<std::string> WithoutEnvelope(const std::string& body) {
  if (body.size() >= kPrefix && body == Enveloped(0, body.substr(kPrefix))) return body.substr(kPrefix);
  return absl::InvalidArgumentError("the body must be one message, after a byte 0 and the four bytes of its length");
}

absl::Status SendStudy(const Solver& solver, const std::string& body, const CallOptions& options, Exchange& exchange) {
  const absl::StatusOr<std::string> message = WithoutEnvelope(body);
  if (!message.ok()) return message.status();
  v1::CostRequest request;
  if (absl::Status wrong = ParseJson("the message", *message, request); !wrong.ok()) return wrong;
  for (const absl::StatusOr<CostChunk>& chunk : solver.Cost(FromProto(request), options)) {
    if (!chunk.ok()) return chunk.status();
    if (!exchange.SendPart(Enveloped(0, JsonOf(ToProto(*chunk))))) return absl::CancelledError("the client has gone");
  }
  return absl::OkStatus();
}

void AnswerCost(const Solver& solver, const std::string& body, const CallOptions& options, Exchange& exchange) {
  exchange.BeginParts(kJsonStream);
  const absl::Status status = SendStudy(solver, body, options, exchange);
  exchange.SendPart(Enveloped(kLast, status.ok() ? "{}" : absl::StrCat("{\"error\":", ErrorText(status), "}")));
  exchange.EndParts();
}

// --- HTTP ---

// Returns the time that the client allows, or nothing for a header that is none.
absl::StatusOr<std::chrono::milliseconds> TimeLimit(const Exchange& exchange) {
  const std::string header = exchange.Header("Connect-Timeout-Ms");
  if (header.empty()) return kLongest;
  int64_t limit = 0;
  if (!absl::SimpleAtoi(header, &limit) || limit < 1 || header.size() > 10) {
    return absl::InvalidArgumentError("Connect-Timeout-Ms: must be a whole number of at most ten digits, from 1 on");
  }
  return std::min(kLongest, std::chrono::milliseconds(limit));
}

// True for the media type, whatever parameters follow it.
bool HasType(const Exchange& exchange, absl::string_view type) {
  const std::string header = exchange.Header("Content-Type");
  const absl::string_view given = absl::StripAsciiWhitespace(absl::string_view(header).substr(0, header.find(';')));
  return absl::AsciiStrToLower(given) == type;
}

bool IsPlain(const Exchange& exchange, const char* header) {
  const std::string encoding = exchange.Header(header);
  return encoding.empty() || encoding == "identity";
}

}  // namespace

void ReplyError(const absl::Status& status, Exchange& exchange) {
  ReplyError(CodeOf(status.code()).http, status, exchange);
}

void AnswerConnect(const Solver& solver, const std::stop_token& stop, Exchange& exchange) {
  absl::string_view name = exchange.path();
  const bool is_of_service = absl::ConsumePrefix(&name, kService);
  const auto* method =
      std::find_if(kMethods.begin(), kMethods.end(), [&](const Method& one) { return one.name == name; });
  const bool is_cost = name == "Cost";
  if (!is_of_service || (method == kMethods.end() && !is_cost)) {
    return ReplyError(404, absl::UnimplementedError(absl::StrCat(exchange.path(), " is no call of one answer here")),
                      exchange);
  }
  if (exchange.method() != "POST") {
    return ReplyError(405, absl::UnimplementedError("the method must be POST"), exchange, "Allow: POST\r\n");
  }
  const char* const type = is_cost ? kJsonStream : kJson;
  if (!HasType(exchange, type)) {
    return ReplyError(415, absl::UnimplementedError(absl::StrCat("Content-Type: must be ", type)), exchange,
                      absl::StrCat("Accept-Post: ", type, "\r\n"));
  }
  if (!IsPlain(exchange, "Content-Encoding") || !IsPlain(exchange, "Connect-Content-Encoding")) {
    return ReplyError(absl::UnimplementedError("a body must not be compressed"), exchange);
  }
  const absl::StatusOr<std::chrono::milliseconds> limit = TimeLimit(exchange);
  if (!limit.ok()) return ReplyError(limit.status(), exchange);
  const CallOptions options = {.stop = stop, .deadline = std::chrono::steady_clock::now() + *limit};
  const absl::StatusOr<std::string> body = exchange.Body();
  if (!body.ok()) return ReplyError(body.status(), exchange);
  if (is_cost) return AnswerCost(solver, *body, options, exchange);
  const Answer answer = method->answer(solver, *body, options);
  if (!answer.ok()) return ReplyError(answer.status(), exchange);
  exchange.Reply(200, kJson, *answer);
}

}  // namespace ricochet::cli
