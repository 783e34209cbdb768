// Commented scenes to start from: one of each system, and some with several contacts. They lie in client/cli/templates.

#ifndef RICOCHET_CLIENT_CLI_INPUT_SCENE_TEMPLATES_H_
#define RICOCHET_CLIENT_CLI_INPUT_SCENE_TEMPLATES_H_

#include <string>
#include <vector>

namespace ricochet::cli {

struct SceneTemplate {
  std::string system;  // "planar_body", or the name of a scene of several contacts.
  std::string text;    // Textproto with comments.
};

// Returns the templates in the order of the systems in ricochet.v1.Scene.
const std::vector<SceneTemplate>& SceneTemplates();

// Returns the templates of ricochet.v1.MultiContactScene.
const std::vector<SceneTemplate>& MultiContactTemplates();

}  // namespace ricochet::cli

#endif  // RICOCHET_CLIENT_CLI_INPUT_SCENE_TEMPLATES_H_
