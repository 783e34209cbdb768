// Parts that the subcommands share: options, the solver behind them, JSON, names of regimes.

#ifndef RICOCHET_CLIENT_CLI_COMMON_H_
#define RICOCHET_CLIENT_CLI_COMMON_H_

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "absl/status/statusor.h"
#include "client/cli/connection_input.h"
#include "ricochet/client_options.h"
#include "ricochet/solver.h"

namespace CLI {
class App;
}

namespace google::protobuf {
class Message;
}

namespace ricochet::cli {

// The work of a subcommand. Parsing the command line sets it, and main then runs it.
using Command = std::function<absl::Status()>;

enum class Format { kText, kJson, kJsonLines, kCsv };

// Formats that programs for arrays open, which sweeps alone have.
enum class ArrayFormat { kNone, kNpy, kNetcdf };

struct CommonOptions {
  ConnectionInput connection;
  Format format = Format::kText;
  ArrayFormat array = ArrayFormat::kNone;  // kNone: `format` holds, or the ending of `output`.
  bool has_format = false;                 // True if --format was given to a sweep.
  std::string output;                      // Empty: standard output.
};

void AddServerOptions(CLI::App& app, CommonOptions& options);
// Adds --format, with jsonl for a subcommand that answers with many points or rows, and --output.
void AddOutputOptions(CLI::App& app, CommonOptions& options, bool has_lines = false);
// The options of sweeps, which also have the formats of arrays.
void AddSweepOutputOptions(CLI::App& app, CommonOptions& options);

// Returns the format of --format, or that of a file that ends in .npy or .nc if --format was not given.
ArrayFormat ArrayFormatOf(const CommonOptions& options);

// Returns the options of a client of the server that is named. Errors: INVALID_ARGUMENT, also if none is named.
absl::StatusOr<ClientOptions> MakeClientOptions(const CommonOptions& options);

// Returns a LocalSolver, or a Client if a server is given. `threads` are those of the LocalSolver, >= 1; absent: one for
// each core. Errors: INVALID_ARGUMENT, also for threads beside a server.
absl::StatusOr<std::unique_ptr<Solver>> MakeSolver(const CommonOptions& options, std::optional<int> threads = {});

// Returns a Client whose sweeps all servers of --server compute together. Errors: INVALID_ARGUMENT, also for less than two
// servers and for threads.
absl::StatusOr<std::unique_ptr<Solver>> MakeFanOut(const CommonOptions& options, std::optional<int> threads);

// Writes `text` to the output that the options name. Errors: those of Output.
absl::Status WriteOutput(const CommonOptions& options, const std::string& text);

// Returns the message as JSON on one line with a line feed (client/cli/json/json_text.h).
std::string Json(const google::protobuf::Message& message);

// Returns the name of a format as a user types it: "csv".
std::string FormatName(Format format);

// Returns the regime as words: "rebound", "stick in compression".
std::string RegimeText(Regime regime);

// Returns the name in ricochet.v1.Regime without its prefix: "REBOUND".
const std::string& RegimeName(Regime regime);

// Returns the name in ricochet.v1.RowStatus without its prefix: "INADMISSIBLE".
const std::string& StatusName(RowStatus status);

}  // namespace ricochet::cli

#endif  // RICOCHET_CLIENT_CLI_COMMON_H_
