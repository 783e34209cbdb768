// Name list: what `--axis ?`, `--column ?` and `--range ?` print.

#ifndef RICOCHET_CLIENT_CLI_INPUT_NAME_LIST_H_
#define RICOCHET_CLIENT_CLI_INPUT_NAME_LIST_H_

#include <string>
#include <vector>

#include "absl/status/status.h"
#include "client/cli/input/scene_input.h"
#include "ricochet/scene.h"

namespace ricochet::cli {

// True if an option was given once, as a question mark.
bool AsksForNames(const std::vector<std::string>& values);

// Prints the names of the scene, one a line; without a scene those of a pendulum.
absl::Status ListNames(const SceneOptions& options, std::vector<std::string> (*names_of)(const Scene&));

}  // namespace ricochet::cli

#endif  // RICOCHET_CLIENT_CLI_INPUT_NAME_LIST_H_
