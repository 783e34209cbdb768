#include "client/cli/input/file_option.h"

#include <algorithm>

#include "absl/strings/str_cat.h"
#include "client/cli/input/shard_input.h"
#include "client/cli/io/output.h"
#include "client/cli/io/output_format.h"

namespace ricochet::cli {
namespace {

// CLI11 keeps a validator with its option, by this name.
const char* MarkOf(FileUse use) { return use == FileUse::kRead ? "read" : "written"; }

bool Has(CLI::Option& option, FileUse use) {
  try {
    return option.get_validator(MarkOf(use)) != nullptr;
  } catch (const CLI::OptionNotFound&) {
    return false;
  }
}

// Returns the flag as a user types it, or nothing for a file that stands without one.
std::string FlagOf(const CLI::Option& option) {
  if (!option.get_snames().empty()) return "-" + option.get_snames().front();
  return option.get_lnames().empty() ? "" : "--" + option.get_lnames().front();
}

}  // namespace

CLI::Option* MarkFile(FileUse use, CLI::Option* option, const std::vector<std::string>& endings) {
  const auto check = [option, endings](const std::string& path) {
    // CLI11 would put its own name of the option before a ValidationError.
    const auto refuse = [&](const std::string& rule) {
      throw CLI::ParseError(absl::StrCat(FlagOf(*option), path.empty() ? "" : " ", path, ": must ", rule),
                            CLI::ExitCodes::ValidationError);
    };
    if (path.empty()) refuse("name a file");
    const bool fits = std::find(endings.begin(), endings.end(), EndingOf(path)) != endings.end();
    if (!fits && !endings.empty() && !IsStandardOutput(path)) refuse("end in " + JoinedEndings(endings));
    return std::string();
  };
  return option->check(CLI::Validator(check, "", MarkOf(use)));
}

void AddHtmlOption(CLI::App& app, const std::string& what, std::string& file) {
  const std::string help =
      absl::StrCat("Write ", what, " as one page that needs nothing beside it; - for standard output");
  MarkFile(FileUse::kWritten, app.add_option("--html", file, help), {"html", "htm"})->type_name("FILE.html");
}

std::optional<FileUse> FileUseOf(CLI::Option& option) {
  for (const FileUse use : {FileUse::kRead, FileUse::kWritten}) {
    if (Has(option, use)) return use;
  }
  return std::nullopt;
}

absl::Status UseFilesOf(CLI::App& app) {
  for (CLI::App* sub : app.get_subcommands()) return UseFilesOf(*sub);
  for (CLI::Option* option : app.get_options()) {
    const std::optional<FileUse> use = FileUseOf(*option);
    const bool is_answer = option->check_lname("output");
    if (!use.has_value() || (is_answer && WritesShard(app))) continue;
    // Only a command with --format writes an answer, which goes to standard output unless --output names a file.
    const bool has_answer = is_answer && app.get_option_no_throw("--format") != nullptr;
    const std::string path = option->count() > 0 ? option->results().back() : has_answer ? "-" : "";
    if (path.empty()) continue;
    const std::string flag = option->count() > 0 ? FlagOf(*option) : "";
    if (absl::Status status = UseFile(*use, flag, path); !status.ok()) return status;
  }
  return absl::OkStatus();
}

}  // namespace ricochet::cli
