// Parts that the subcommands share: options, the solver behind them, JSON, names of regimes.

#ifndef RICOCHET_CLIENT_CLI_COMMON_H_
#define RICOCHET_CLIENT_CLI_COMMON_H_

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "absl/status/statusor.h"
#include "absl/types/span.h"
#include "client/cli/connection_input.h"
#include "client/cli/output_format.h"
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

struct CommonOptions {
  ConnectionInput connection;
  Format format = Format::kText;  // That of --format or of the ending of `output`.
  std::string named_format;       // --format as it was typed; empty if it was not given.
  std::string output;             // Empty: standard output.
};

void AddServerOptions(CLI::App& app, CommonOptions& options);

// The formats of an answer that is one message, of one that may have many rows, and of a sweep.
inline constexpr std::array kMessageFormats = {Format::kText, Format::kJson, Format::kCsv};
inline constexpr std::array kRowFormats = {Format::kText, Format::kJson, Format::kJsonLines, Format::kCsv};
inline constexpr std::array kSweepFormats = {Format::kText, Format::kJson, Format::kJsonLines,
                                             Format::kCsv,  Format::kNpy,  Format::kNetcdf};

// Adds --output, and --format if there is a choice. A parse that succeeds leaves the format chosen (ChooseFormat).
// `formats` must outlive the app.
void AddOutputOptions(CLI::App& app, CommonOptions& options, absl::Span<const Format> formats);

// Calls the function that makes the text of an answer: `text`, `json` or `csv`. An answer of one message is one line of
// jsonl.
template <typename Text, typename AsJson, typename Csv>
absl::StatusOr<std::string> Render(Format format, Text text, AsJson json, Csv csv) {
  if (format == Format::kText) return text();
  return format == Format::kCsv ? csv() : json();
}

// Returns how many of `rows` rows a table for people has: the first 40 on standard output, all in a file.
// Errors: INVALID_ARGUMENT for a file of more than 100,000, which would not fit into the memory of every machine.
absl::StatusOr<int64_t> RowsOfTable(const CommonOptions& options, int64_t rows);

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

// Returns the regime as words: "rebound", "stick in compression".
std::string RegimeText(Regime regime);

// Returns the name in ricochet.v1.Regime without its prefix: "REBOUND".
const std::string& RegimeName(Regime regime);

// Returns the name in ricochet.v1.RowStatus without its prefix: "INADMISSIBLE".
const std::string& StatusName(RowStatus status);

}  // namespace ricochet::cli

#endif  // RICOCHET_CLIENT_CLI_COMMON_H_
