// The subcommands of ricochet, each in a source of its name. Each function adds one to the program: its options, its
// help, and what parsing it makes of `command`.

#ifndef RICOCHET_CLIENT_CLI_SUBCOMMANDS_H_
#define RICOCHET_CLIENT_CLI_SUBCOMMANDS_H_

#include <string>
#include <vector>

#include "client/cli/input/command_options.h"

namespace ricochet::cli {

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

#endif  // RICOCHET_CLIENT_CLI_SUBCOMMANDS_H_
