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

#include "absl/status/status.h"
#include "client/cli/explore/web_server.h"
#include "ricochet/solver.h"

namespace ricochet::cli {

// Answers a request. A call takes at most a minute, as in ricochetd, or the time that the client allows
// (Connect-Timeout-Ms), and ends when `stop` says so.
void AnswerConnect(const Solver& solver, const std::stop_token& stop, Exchange& exchange);

// Answers with an error.
void ReplyError(const absl::Status& status, Exchange& exchange);

}  // namespace ricochet::cli

#endif  // RICOCHET_CLIENT_CLI_EXPLORE_CONNECT_H_
