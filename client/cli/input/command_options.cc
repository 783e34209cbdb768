#include "client/cli/input/command_options.h"

#include <CLI/App.hpp>
#include <algorithm>
#include <utility>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "client/cli/input/file_option.h"
#include "client/cli/input/shard_input.h"
#include "client/cli/io/output.h"
#include "client/cli/text/table.h"

namespace ricochet::cli {

CLI::App* AddSubcommand(CLI::App& app, const char* name, const char* help, const char* example, Command run,
                        Command& command) {
  CLI::App* sub = app.add_subcommand(name, help);
  sub->footer(example);
  sub->callback([run = std::move(run), &command] { command = run; });
  return sub;
}

CLI::Option* AddRepeatable(CLI::App& app, const char* name, std::vector<std::string>& values, const std::string& help) {
  return app.add_option(name, values, help)->allow_extra_args(false);
}

CLI::Option* AddList(CLI::App& app, const char* name, std::vector<std::string>& values, const std::string& help) {
  return AddRepeatable(app, name, values, help)->delimiter(',');
}

void AddOutputOptions(CLI::App& app, CommonOptions& options, absl::Span<const Format> formats) {
  options.format = formats.front();
  if (formats.size() > 1) {
    const auto append_meaning = [](std::string* text, Format format) {
      absl::StrAppend(text, FormatName(format), ": ", FormatMeaning(format));
    };
    std::vector<std::string> names;
    for (const Format format : formats) names.push_back(FormatName(format));
    app.add_option_function<std::string>(
           "--format",
           [&options, formats](const std::string& name) {
             options.named_format = name;
             options.format = *ChooseFormat(formats, name, "");
           },
           absl::StrCat(absl::StrJoin(formats, "; ", append_meaning), " [what FILE ends in, else ", names.front(), "]"))
        ->check(CLI::IsMember(names))
        ->option_text(absl::StrJoin(names, "|"));
  }
  const auto take = [&app, &options, formats](const std::string& path) {
    if (!IsStandardOutput(path)) options.output = path;
    if (WritesShard(app)) return;
    const absl::StatusOr<Format> format = ChooseFormat(formats, options.named_format, options.output);
    const std::string flag = FlagForFile(path);
    if (!format.ok()) {
      const bool has_flag = !flag.empty() && app.get_option_no_throw(flag) != nullptr;
      throw CLI::ValidationError(absl::StrCat(format.status().message(),
                                              has_flag ? absl::StrCat("; did you mean ", flag, " ", path, "?") : ""));
    }
    options.format = *format;
    if (!options.output.empty() && !IsDevice(path)) ForgetTerminalWidth();
  };
  MarkFile(FileUse::kWritten,
           app.add_option_function<std::string>("-o,--output", take,
                                                "Write to this file, which is replaced only when the output is "
                                                "complete; - for standard output"))
      ->type_name("FILE");
}

absl::StatusOr<int64_t> RowsOfTable(const CommonOptions& options, int64_t rows) {
  constexpr int64_t kShown = 40;
  constexpr int64_t kMost = 100'000;
  if (options.output.empty() || IsDevice(options.output)) return std::min(rows, kShown);
  if (rows <= kMost) return rows;
  return absl::InvalidArgumentError(absl::StrCat("-o ", options.output, ": a table for people of ", rows,
                                                 " rows: must have at most ", kMost, ", or be csv"));
}

absl::Status WriteOutput(const CommonOptions& options, const std::string& text) {
  return WriteFile(options.output, text);
}

}  // namespace ricochet::cli
