// Connect: the calls of the service as HTTP with JSON, in the Connect protocol (connectrpc.com/docs/protocol).
//
//   POST /ricochet.v1.ImpactService/Solve     a SolveRequest as JSON gets a SolveResponse
//
// So does every call of one request and one answer. Cost has a stream of answers, which are sent together. JSON is read
// by the rules of protobuf and written as the command line writes it, which these rules read as well. An error is
// {"code", "message", "details"}, and its details carry the violations as they do over gRPC.

#ifndef RICOCHET_CLIENT_CLI_EXPLORE_CONNECT_H_
#define RICOCHET_CLIENT_CLI_EXPLORE_CONNECT_H_

#include <stop_token>
#include <string>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"
#include "client/cli/explore/web_server.h"
#include "ricochet/solver.h"

namespace ricochet::cli {

// Answers a request. A call takes at most a minute, as in ricochetd, or the time that the client allows
// (Connect-Timeout-Ms), and ends when `stop` says so.
void AnswerConnect(const Solver& solver, const std::stop_token& stop, Exchange& exchange);

// Asks for a call of one answer by its name, as "Solve", with a request in JSON, and returns the answer in JSON.
absl::StatusOr<std::string> AskInJson(const Solver& solver, absl::string_view method, const std::string& body);

// Returns {"code": ..., "message": ..., "details": [...]}.
std::string ErrorJson(const absl::Status& status);

// Answers with an error.
void ReplyError(const absl::Status& status, Exchange& exchange);

}  // namespace ricochet::cli

#endif  // RICOCHET_CLIENT_CLI_EXPLORE_CONNECT_H_
