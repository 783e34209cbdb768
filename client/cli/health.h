// The subcommand health: asks whether a server takes calls.

#ifndef RICOCHET_CLIENT_CLI_HEALTH_H_
#define RICOCHET_CLIENT_CLI_HEALTH_H_

#include "client/cli/common.h"

namespace ricochet::cli {

void AddHealth(CLI::App& app, Command& command);

}  // namespace ricochet::cli

#endif  // RICOCHET_CLIENT_CLI_HEALTH_H_
