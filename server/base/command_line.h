// CommandLine: the options of ricochetd, for programs that describe them.

#ifndef RICOCHET_SERVER_BASE_COMMAND_LINE_H_
#define RICOCHET_SERVER_BASE_COMMAND_LINE_H_

#include <CLI/App.hpp>
#include <memory>

namespace ricochet::server {

// Returns the command line that ParseCommandLine of server/options.h reads.
std::unique_ptr<CLI::App> MakeCommandLine();

}  // namespace ricochet::server

#endif  // RICOCHET_SERVER_BASE_COMMAND_LINE_H_
