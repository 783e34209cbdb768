// The subcommand `scene`: what scenes look like.

#ifndef RICOCHET_CLIENT_CLI_SCENE_H_
#define RICOCHET_CLIENT_CLI_SCENE_H_

#include "client/cli/common.h"

namespace CLI {
class App;
}

namespace ricochet::cli {

void AddScene(CLI::App& app, Command& command);

}  // namespace ricochet::cli

#endif  // RICOCHET_CLIENT_CLI_SCENE_H_
