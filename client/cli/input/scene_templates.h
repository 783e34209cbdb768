// A commented scene of each system, to start from. They lie in client/cli/templates.

#ifndef RICOCHET_CLIENT_CLI_INPUT_SCENE_TEMPLATES_H_
#define RICOCHET_CLIENT_CLI_INPUT_SCENE_TEMPLATES_H_

#include <string>
#include <vector>

namespace ricochet::cli {

struct SceneTemplate {
  std::string system;  // "planar_body".
  std::string text;    // Textproto with comments.
};

// Returns the templates in the order of the systems in ricochet.v1.Scene.
const std::vector<SceneTemplate>& SceneTemplates();

}  // namespace ricochet::cli

#endif  // RICOCHET_CLIENT_CLI_INPUT_SCENE_TEMPLATES_H_
