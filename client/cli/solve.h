// ricochet solve: one impact.

#ifndef RICOCHET_CLIENT_CLI_SOLVE_H_
#define RICOCHET_CLIENT_CLI_SOLVE_H_

#include "client/cli/common.h"

namespace ricochet::cli {

void AddSolve(CLI::App& app, Command& command);

}  // namespace ricochet::cli

#endif  // RICOCHET_CLIENT_CLI_SOLVE_H_
