// ricochet plot: a picture of a file that ricochet sweep wrote.

#ifndef RICOCHET_CLIENT_CLI_PLOT_FILE_H_
#define RICOCHET_CLIENT_CLI_PLOT_FILE_H_

#include "client/cli/common.h"

namespace ricochet::cli {

void AddPlotFile(CLI::App& app, Command& command);

}  // namespace ricochet::cli

#endif  // RICOCHET_CLIENT_CLI_PLOT_FILE_H_
