// Program: the subcommands of ricochet, put together.

#ifndef RICOCHET_CLIENT_CLI_PROGRAM_H_
#define RICOCHET_CLIENT_CLI_PROGRAM_H_

#include <CLI/App.hpp>
#include <memory>
#include <string>
#include <vector>

#include "client/cli/input/command_options.h"

namespace ricochet::cli {

// Returns the command line. Parsing it sets `command`, which must outlive it. `arguments` are those of main, which a
// sweep keeps to say how it can be resumed.
std::unique_ptr<CLI::App> MakeProgram(std::vector<std::string> arguments, Command& command);

// Returns the words after the name of the program in the spelling of the options: `help solve` is `solve --help`, and
// `version` is `--version`.
std::vector<std::string> WithHelpAsFlag(std::vector<std::string> words);

}  // namespace ricochet::cli

#endif  // RICOCHET_CLIENT_CLI_PROGRAM_H_
