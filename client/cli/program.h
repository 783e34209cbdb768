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

// Each of these adds one subcommand, which has a source of its name, to the program: its options, its help, and what
// parsing it makes of `command`.
void AddAudit(CLI::App& app, Command& command);
void AddBounds(CLI::App& app, Command& command);
void AddConformance(CLI::App& app, Command& command);
void AddCost(CLI::App& app, Command& command);
void AddExplore(CLI::App& app, Command& command);
void AddFit(CLI::App& app, Command& command);
void AddHealth(CLI::App& app, Command& command);
void AddInfo(CLI::App& app, Command& command);
void AddMerge(CLI::App& app, Command& command);
void AddMultiContact(CLI::App& app, Command& command);
void AddPlot(CLI::App& app, Command& command);
void AddScene(CLI::App& app, Command& command);
void AddSolve(CLI::App& app, Command& command);
// `arguments` are those of the whole program, its name first: an unfinished sweep shows the command that goes on.
void AddSweep(CLI::App& app, std::vector<std::string> arguments, Command& command);

}  // namespace ricochet::cli

#endif  // RICOCHET_CLIENT_CLI_PROGRAM_H_
