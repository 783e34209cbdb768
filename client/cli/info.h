// The subcommand info: says which engine answers, what it can answer, and how large and how long a call may be.

#ifndef RICOCHET_CLIENT_CLI_INFO_H_
#define RICOCHET_CLIENT_CLI_INFO_H_

#include "client/cli/common.h"

namespace ricochet::cli {

void AddInfo(CLI::App& app, Command& command);

}  // namespace ricochet::cli

#endif  // RICOCHET_CLIENT_CLI_INFO_H_
