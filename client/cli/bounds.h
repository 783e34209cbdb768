// ricochet bounds: the coefficients that an impact can have.

#ifndef RICOCHET_CLIENT_CLI_BOUNDS_H_
#define RICOCHET_CLIENT_CLI_BOUNDS_H_

#include "client/cli/common.h"

namespace ricochet::cli {

void AddBounds(CLI::App& app, Command& command);

}  // namespace ricochet::cli

#endif  // RICOCHET_CLIENT_CLI_BOUNDS_H_
