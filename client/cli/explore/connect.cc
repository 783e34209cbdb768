#include "client/cli/explore/connect.h"

#include <google/protobuf/util/json_util.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdint>
#include <functional>
#include <string>

#include "absl/strings/escaping.h"
#include "absl/strings/match.h"
#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/strip.h"
#include "client/cli/input/scene_input.h"
#include "client/cli/text/json_text.h"
#include "google/rpc/status.pb.h"
#include "proto/wire/audit.h"
#include "proto/wire/batch.h"
#include "proto/wire/cost.h"
#include "proto/wire/info.h"
#include "proto/wire/multi_contact.h"
#include "proto/wire/requests.h"
#include "proto/wire/status.h"

namespace ricochet::cli {
namespace {

constexpr char kService[] = "/ricochet.v1.ImpactService/";
constexpr char kJson[] = "application/json";
constexpr char kJsonStream[] = "application/connect+json";
constexpr std::chrono::milliseconds kLongest = std::chrono::minutes(1);

// --- Errors ---

// The codes of Connect and their statuses of HTTP, by the numbers of gRPC.
constexpr std::array<const char*, 17> kCodes = {
    "ok",        "canceled",       "unknown",           "invalid_argument",   "deadline_exceeded",
    "not_found", "already_exists", "permission_denied", "resource_exhausted", "failed_precondition",
    "aborted",   "out_of_range",   "unimplemented",     "internal",           "unavailable",
    "data_loss", "unauthenticated"};
constexpr std::array<int, 17> kStatuses = {200, 499, 500, 400, 504, 404, 409, 403, 429,
                                           400, 409, 400, 501, 500, 503, 500, 401};

// Returns a detail: its bytes in base64 without padding, and the same in JSON for people and for pages.
std::string DetailText(const google::protobuf::Any& any) {
  std::string bytes = absl::Base64Escape(any.value());
  bytes.erase(bytes.find_last_not_of('=') + 1);
  std::string json;
  if (!google::protobuf::util::MessageToJsonString(any, &json).ok()) json = "null";
  return absl::StrCat(R"({"type":")", any.type_url().substr(any.type_url().rfind('/') + 1), R"(","value":")", bytes,
                      R"(","debug":)", json, "}");
}

// --- Calls: the JSON text of the answer to a request in JSON ---

using Answer = absl::StatusOr<std::string>;

// `method` is that of the Solver for the request.
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
  const auto summary = BatchExchange().Answer(*session, setup.columns.size(), request, response);
  if (!summary.ok()) return summary.status();
  return JsonOf(response);
}

// In a stream each message has a byte of flags and four of its length in front.
constexpr size_t kPrefix = 5;
constexpr char kLast = 2;

std::string Enveloped(char flags, const std::string& text) {
  std::string prefix(1, flags);
  for (int shift = 24; shift >= 0; shift -= 8) prefix.push_back(static_cast<char>(text.size() >> shift));
  return prefix + text;
}

absl::Status AppendStudy(const Solver& solver, const std::string& body, const CallOptions& options, std::string& text) {
  if (body.size() < kPrefix || body != Enveloped(0, body.substr(kPrefix))) {
    return absl::InvalidArgumentError("the body must be one message, after a byte 0 and the four bytes of its length");
  }
  v1::CostRequest request;
  if (absl::Status wrong = ParseJson("the message", body.substr(kPrefix), request); !wrong.ok()) return wrong;
  for (const absl::StatusOr<CostChunk>& chunk : solver.Cost(FromProto(request), options)) {
    if (!chunk.ok()) return chunk.status();
    text += Enveloped(0, JsonOf(ToProto(*chunk)));
  }
  return absl::OkStatus();
}

// A stream tells of its error at its end.
Answer AnswerCost(const Solver& solver, const std::string& body, const CallOptions& options) {
  std::string text;
  const absl::Status status = AppendStudy(solver, body, options, text);
  return text + Enveloped(kLast, status.ok() ? "{}" : absl::StrCat("{\"error\":", ErrorJson(status), "}"));
}

struct Method {
  const char* name;
  const char* type;  // That of the bodies.
  Answer (*answer)(const Solver&, const std::string&, const CallOptions&);
};

constexpr std::array kMethods = {
    Method{"Solve", kJson, &AnswerUnary<v1::SolveRequest, &Solver::Solve>},
    Method{"Plan", kJson, &AnswerUnary<v1::PlanRequest, &Solver::Plan>},
    Method{"Bounds", kJson, &AnswerUnary<v1::BoundsRequest, &Solver::Bounds>},
    Method{"Audit", kJson, &AnswerUnary<v1::AuditRequest, &Solver::Audit>},
    Method{"AuditBatch", kJson, &AnswerUnary<v1::AuditBatchRequest, &Solver::AuditBatch>},
    Method{"SolveBatch", kJson, &AnswerBatch},
    Method{"MultiContact", kJson, &AnswerUnary<v1::MultiContactRequest, &Solver::MultiContact>},
    Method{"Cost", kJsonStream, &AnswerCost},
    Method{"Info", kJson, &AnswerUnary<v1::InfoRequest, &Solver::Info>}};

// Returns null for a name of no call that is served.
const Method* FindMethod(absl::string_view name) {
  const auto* const found =
      std::find_if(kMethods.begin(), kMethods.end(), [&](const Method& one) { return one.name == name; });
  return found == kMethods.end() ? nullptr : found;
}

// Returns the time that the client allows. Errors: INVALID_ARGUMENT for a header that says none.
absl::StatusOr<std::chrono::milliseconds> TimeLimit(const Exchange& exchange) {
  const std::string header = exchange.Header("Connect-Timeout-Ms");
  int64_t limit = 0;
  if (header.empty()) return kLongest;
  if (absl::SimpleAtoi(header, &limit) && limit > 0) return std::min(kLongest, std::chrono::milliseconds(limit));
  return absl::InvalidArgumentError("Connect-Timeout-Ms: must be a whole number from 1 on");
}

// Reads the request and asks the solver.
Answer Ask(const Method& method, const Solver& solver, const std::stop_token& stop, Exchange& exchange) {
  const absl::StatusOr<std::chrono::milliseconds> limit = TimeLimit(exchange);
  if (!limit.ok()) return limit.status();
  const CallOptions options = {.stop = stop, .deadline = std::chrono::steady_clock::now() + *limit};
  const absl::StatusOr<std::string> body = exchange.Body();
  return body.ok() ? method.answer(solver, *body, options) : body.status();
}

}  // namespace

std::string ErrorJson(const absl::Status& status) {
  const grpc::Status sent = ToGrpcStatus(status);
  std::string text = absl::StrCat(R"({"code":")", kCodes.at(static_cast<size_t>(status.code())), R"(","message":)");
  AppendJson(sent.error_message(), text);
  google::rpc::Status proto;
  proto.ParseFromString(sent.error_details());
  for (int i = 0; i < proto.details_size(); ++i) {
    absl::StrAppend(&text, i == 0 ? ",\"details\":[" : ",", DetailText(proto.details(i)));
  }
  return text + (proto.details().empty() ? "}" : "]}");
}

absl::StatusOr<std::string> AskInJson(const Solver& solver, absl::string_view method, const std::string& body) {
  return FindMethod(method)->answer(solver, body, {});
}

void ReplyError(const absl::Status& status, Exchange& exchange) {
  exchange.Reply(kStatuses.at(static_cast<size_t>(status.code())), kJson, ErrorJson(status));
}

void AnswerConnect(const Solver& solver, const std::stop_token& stop, Exchange& exchange) {
  absl::string_view name = exchange.path();
  const Method* const method = absl::ConsumePrefix(&name, kService) ? FindMethod(name) : nullptr;
  const auto refuse = [&](int http, const std::string& why, const std::string& header) {
    exchange.Reply(http, kJson, ErrorJson(absl::UnimplementedError(why)), header);
  };
  if (method == nullptr) return refuse(404, absl::StrCat(exchange.path(), " is no call that is served here"), "");
  if (exchange.method() != "POST") return refuse(405, "the method must be POST", "Allow: POST\r\n");
  const std::string type = exchange.Header("Content-Type");
  if (!absl::EqualsIgnoreCase(absl::StripAsciiWhitespace(type.substr(0, type.find(';'))), method->type)) {
    return refuse(415, absl::StrCat("Content-Type: must be ", method->type),
                  absl::StrCat("Accept-Post: ", method->type, "\r\n"));
  }
  const Answer answer = Ask(*method, solver, stop, exchange);
  if (!answer.ok()) return ReplyError(answer.status(), exchange);
  exchange.Reply(200, method->type, *answer);
}

}  // namespace ricochet::cli
