// What the subcommands share: options, the solver behind them, JSON.

#ifndef RICOCHET_CLIENT_CLI_COMMON_H_
#define RICOCHET_CLIENT_CLI_COMMON_H_

#include <CLI/App.hpp>
#include <functional>
#include <memory>
#include <string>

#include "absl/status/statusor.h"
#include "ricochet/client_options.h"
#include "ricochet/solver.h"

namespace google::protobuf {
class Message;
}

namespace ricochet::cli {

// What a subcommand does once its options are parsed. Parsing sets it; main runs it.
using Command = std::function<absl::Status()>;

enum class Format { kText, kJson, kCsv };

struct CommonOptions {
  std::string server;  // Empty: this process computes.
  std::string deadline;
  Format format = Format::kText;
  std::string output;  // Empty: standard output.
};

void AddServerOptions(CLI::App& app, CommonOptions& options);
void AddOutputOptions(CLI::App& app, CommonOptions& options);

// The options of a client of `options.server`. Errors: INVALID_ARGUMENT.
absl::StatusOr<ClientOptions> MakeClientOptions(const CommonOptions& options);

// A LocalSolver, or a Client if there is a server. Errors: INVALID_ARGUMENT.
absl::StatusOr<std::unique_ptr<Solver>> MakeSolver(const CommonOptions& options);

// Writes `text` to the output that the options name.
absl::Status WriteOutput(const CommonOptions& options, const std::string& text);

// Canonical proto3 JSON on one line, default values included, with a line feed.
absl::StatusOr<std::string> Json(const google::protobuf::Message& message);

// "rebound", "stick in compression".
std::string RegimeText(Regime regime);

// "REBOUND", as ricochet.v1.Regime without its prefix.
const std::string& RegimeName(Regime regime);

}  // namespace ricochet::cli

#endif  // RICOCHET_CLIENT_CLI_COMMON_H_
