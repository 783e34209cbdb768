// Options whose values are files. Each says whether the command reads or writes its file, so that one check knows them
// all.

#ifndef RICOCHET_CLIENT_CLI_INPUT_FILE_OPTION_H_
#define RICOCHET_CLIENT_CLI_INPUT_FILE_OPTION_H_

#include <CLI/App.hpp>
#include <optional>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "client/cli/io/used_files.h"

namespace ricochet::cli {

// Says that the value of `option` is a file of this use. A parse then refuses an empty name and, unless `endings` is
// empty, a name that is not standard output and ends in none of them.
CLI::Option* MarkFile(FileUse use, CLI::Option* option, const std::vector<std::string>& endings = {});

// Adds --html, which writes `what` as a page.
void AddHtmlOption(CLI::App& app, const std::string& what, std::string& file);

// The use that MarkFile said; none for an option of another kind.
std::optional<FileUse> FileUseOf(CLI::Option& option);

// Notes all files that the options of the subcommand name (client/cli/io/used_files.h), and that it writes its answer
// to standard output unless -o names a file. Errors: those of UseFile.
absl::Status UseFilesOf(CLI::App& app);

}  // namespace ricochet::cli

#endif  // RICOCHET_CLIENT_CLI_INPUT_FILE_OPTION_H_
