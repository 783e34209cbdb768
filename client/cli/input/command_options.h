// CommandOptions: what every subcommand that computes is told of its server and its output.

#ifndef RICOCHET_CLIENT_CLI_INPUT_COMMAND_OPTIONS_H_
#define RICOCHET_CLIENT_CLI_INPUT_COMMAND_OPTIONS_H_

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "absl/status/statusor.h"
#include "absl/types/span.h"
#include "client/cli/input/connection_input.h"
#include "client/cli/io/output_format.h"
#include "client/cli/text/json_text.h"

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace ricochet::cli {

// The work of a subcommand. Parsing the command line sets it, and main then runs it.
using Command = std::function<absl::Status()>;

// Adds a subcommand, with `example` below its help, that sets `command` to `run`.
CLI::App* AddSubcommand(CLI::App& app, const char* name, const char* help, const char* example, Command run,
                        Command& command);

// Adds a subcommand that has options of its own, which live as long as it does.
template <typename Options>
std::pair<CLI::App*, Options*> AddCommand(CLI::App& app, const char* name, const char* help, const char* example,
                                          std::function<absl::Status(const Options&)> run, Command& command) {
  const auto options = std::make_shared<Options>();
  const auto run_with_options = [options, run = std::move(run)] { return run(*options); };
  return {AddSubcommand(app, name, help, example, run_with_options, command), options.get()};
}

// Adds an option that takes one value each time that it is given, or a list of values between commas.
CLI::Option* AddRepeatable(CLI::App& app, const char* name, std::vector<std::string>& values, const std::string& help);
CLI::Option* AddList(CLI::App& app, const char* name, std::vector<std::string>& values, const std::string& help);

struct CommonOptions {
  ConnectionInput connection;
  Format format = Format::kText;  // --format states it, or the ending of `output`.
  std::string named_format;       // --format as it was typed; empty if it was not given.
  std::string output;             // Empty: standard output.
};

// The formats of an answer that is one message, of one that may have many rows, and of a sweep.
inline constexpr std::array kMessageFormats = {Format::kText, Format::kJson, Format::kCsv};
inline constexpr std::array kRowFormats = {Format::kText, Format::kJson, Format::kJsonLines, Format::kCsv};
inline constexpr std::array kSweepFormats = {Format::kText, Format::kJson, Format::kJsonLines,
                                             Format::kCsv,  Format::kNpy,  Format::kNetcdf};

// Adds --output, and --format if there is a choice. A parse that succeeds leaves the format chosen (ChooseFormat).
// `formats` must outlive the app.
void AddOutputOptions(CLI::App& app, CommonOptions& options, absl::Span<const Format> formats);

// Returns how many of `rows` rows a table for people has: the first 40 on standard output, all in a file.
// Errors: INVALID_ARGUMENT for a file of more than 100,000, which would not fit into the memory of every machine.
absl::StatusOr<int64_t> RowsOfTable(const CommonOptions& options, int64_t rows);

// Writes `text` to the output that the options name. Errors: those of Output.
absl::Status WriteOutput(const CommonOptions& options, const std::string& text);

// Writes an answer of one message: `text()`, `csv()`, or the message as a line of JSON, which is one of jsonl, too.
// Errors: those of Output.
template <typename Answer, typename Text, typename Csv>
absl::Status WriteAnswer(const CommonOptions& options, const Answer& answer, Text text, Csv csv) {
  if (options.format == Format::kText) return WriteOutput(options, text());
  return WriteOutput(options, options.format == Format::kCsv ? csv() : JsonLineOf(ToProto(answer)));
}

}  // namespace ricochet::cli

#endif  // RICOCHET_CLIENT_CLI_INPUT_COMMAND_OPTIONS_H_
