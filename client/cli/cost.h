// ricochet cost: what accuracy costs in time.

#ifndef RICOCHET_CLIENT_CLI_COST_H_
#define RICOCHET_CLIENT_CLI_COST_H_

#include "client/cli/common.h"

namespace ricochet::cli {

void AddCost(CLI::App& app, Command& command);

}  // namespace ricochet::cli

#endif  // RICOCHET_CLIENT_CLI_COST_H_
