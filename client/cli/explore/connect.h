// Connect: the calls of the service as HTTP with JSON, in the Connect protocol (connectrpc.com/docs/protocol).
//
//   POST /ricochet.v1.ImpactService/Solve     a SolveRequest as JSON gets a SolveResponse
//
// So does every call of one request and one answer. JSON is read by the rules of protobuf and written as the command
// line writes it, which these rules read as well. An error is {"code", "message", "details"}, and its details carry the
// violations as they do over gRPC.

#ifndef RICOCHET_CLIENT_CLI_EXPLORE_CONNECT_H_
#define RICOCHET_CLIENT_CLI_EXPLORE_CONNECT_H_

#include <functional>
#include <stop_token>
#include <string>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"
#include "client/cli/explore/web_server.h"
#include "ricochet/solver.h"

namespace ricochet::cli {

// Makes the JSON text of an answer from that of a request.
using JsonCall = std::function<absl::StatusOr<std::string>(const std::string& body, const CallOptions& options)>;

// Answers a POST of JSON. A call takes at most a minute, as in ricochetd, or the time that the client allows
// (Connect-Timeout-Ms), and ends when `stop` says so. Null is a call that is not served.
void AnswerPost(const JsonCall& call, const std::stop_token& stop, Exchange& exchange);

// Returns the call of a method of the service, such as "Solve"; null for one that is not served.
JsonCall FindCall(const Solver& solver, absl::string_view method);

// Returns {"code": ..., "message": ..., "details": [...]}.
std::string ErrorJson(const absl::Status& status);

// Answers with an error.
void ReplyError(const absl::Status& status, Exchange& exchange);

}  // namespace ricochet::cli

#endif  // RICOCHET_CLIENT_CLI_EXPLORE_CONNECT_H_
