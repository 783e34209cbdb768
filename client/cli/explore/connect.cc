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
#include "absl/strings/match.h"
#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "client/cli/input/scene_input.h"
#include "client/cli/text/json_text.h"
#include "google/rpc/status.pb.h"
#include "proto/wire/audit.h"
#include "proto/wire/batch.h"
#include "proto/wire/fit.h"
#include "proto/wire/info.h"
#include "proto/wire/multi_contact.h"
#include "proto/wire/requests.h"
#include "proto/wire/status.h"

namespace ricochet::cli {
namespace {

constexpr char kJson[] = "application/json";
constexpr std::chrono::milliseconds kLongest = std::chrono::minutes(1);

// Returns the code of Connect, which is that of gRPC in small letters, but for one.
std::string CodeText(const absl::Status& status) {
  return absl::IsCancelled(status) ? "canceled" : absl::AsciiStrToLower(absl::StatusCodeToString(status.code()));
}

// The statuses of HTTP, by the numbers of gRPC's codes.
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

// The JSON text of the answer to a request in JSON.
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

constexpr std::pair<const char*, Answer (*)(const Solver&, const std::string&, const CallOptions&)> kMethods[] = {
    {"Solve", &AnswerUnary<v1::SolveRequest, &Solver::Solve>},
    {"Plan", &AnswerUnary<v1::PlanRequest, &Solver::Plan>},
    {"Bounds", &AnswerUnary<v1::BoundsRequest, &Solver::Bounds>},
    {"Audit", &AnswerUnary<v1::AuditRequest, &Solver::Audit>},
    {"AuditBatch", &AnswerUnary<v1::AuditBatchRequest, &Solver::AuditBatch>},
    {"SolveBatch", &AnswerBatch},
    {"MultiContact", &AnswerUnary<v1::MultiContactRequest, &Solver::MultiContact>},
    {"Fit", &AnswerUnary<v1::FitRequest, &Solver::Fit>},
    {"Info", &AnswerUnary<v1::InfoRequest, &Solver::Info>}};

void Refuse(int http, const std::string& why, const std::string& header, Exchange& exchange) {
  exchange.Reply(http, kJson, ErrorJson(absl::UnimplementedError(why)), header);
}

}  // namespace

std::string ErrorJson(const absl::Status& status) {
  const grpc::Status sent = ToGrpcStatus(status);
  std::string text = absl::StrCat(R"({"code":")", CodeText(status), R"(","message":)");
  AppendJson(sent.error_message(), text);
  google::rpc::Status proto;
  proto.ParseFromString(sent.error_details());
  for (int i = 0; i < proto.details_size(); ++i) {
    absl::StrAppend(&text, i == 0 ? ",\"details\":[" : ",", DetailText(proto.details(i)));
  }
  return text + (proto.details().empty() ? "}" : "]}");
}

JsonCall FindCall(const Solver& solver, absl::string_view method) {
  for (const auto& [name, answer] : kMethods) {
    if (method == name) return std::bind_front(answer, std::cref(solver));
  }
  return nullptr;
}

void ReplyError(const absl::Status& status, Exchange& exchange) {
  exchange.Reply(kStatuses.at(static_cast<size_t>(status.code())), kJson, ErrorJson(status));
}

void AnswerPost(const JsonCall& call, const std::stop_token& stop, Exchange& exchange) {
  if (call == nullptr) return Refuse(404, absl::StrCat(exchange.path(), " is not served here"), "", exchange);
  if (exchange.method() != "POST") return Refuse(405, "the method must be POST", "Allow: POST\r\n", exchange);
  const std::string type = exchange.Header("Content-Type");
  if (!absl::EqualsIgnoreCase(absl::StripAsciiWhitespace(type.substr(0, type.find(';'))), kJson)) {
    return Refuse(415, "Content-Type: must be application/json", "Accept-Post: application/json\r\n", exchange);
  }
  int64_t limit = kLongest.count();
  const std::string header = exchange.Header("Connect-Timeout-Ms");
  if (!header.empty() && !(absl::SimpleAtoi(header, &limit) && limit > 0)) {
    return ReplyError(absl::InvalidArgumentError("Connect-Timeout-Ms: must be a whole number from 1 on"), exchange);
  }
  const auto deadline = std::chrono::steady_clock::now() + std::min(kLongest, std::chrono::milliseconds(limit));
  const absl::StatusOr<std::string> body = exchange.Body();
  const Answer answer = body.ok() ? call(*body, {.stop = stop, .deadline = deadline}) : body.status();
  if (!answer.ok()) return ReplyError(answer.status(), exchange);
  exchange.Reply(200, kJson, *answer);
}

}  // namespace ricochet::cli
