// ricochet sweep: many impacts over a grid.

#ifndef RICOCHET_CLIENT_CLI_SWEEP_H_
#define RICOCHET_CLIENT_CLI_SWEEP_H_

#include <string>
#include <vector>

#include "client/cli/common.h"

namespace ricochet::cli {

// `arguments` are those of the whole program, its name first: an unfinished sweep shows the command that goes on.
void AddSweep(CLI::App& app, std::vector<std::string> arguments, Command& command);

}  // namespace ricochet::cli

#endif  // RICOCHET_CLIENT_CLI_SWEEP_H_
