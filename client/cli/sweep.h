// ricochet sweep: many impacts over a grid.

#ifndef RICOCHET_CLIENT_CLI_SWEEP_H_
#define RICOCHET_CLIENT_CLI_SWEEP_H_

#include "client/cli/common.h"

namespace ricochet::cli {

void AddSweep(CLI::App& app, Command& command);

}  // namespace ricochet::cli

#endif  // RICOCHET_CLIENT_CLI_SWEEP_H_
