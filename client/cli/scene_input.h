// Scenes from files and from flags.

#ifndef RICOCHET_CLIENT_CLI_SCENE_INPUT_H_
#define RICOCHET_CLIENT_CLI_SCENE_INPUT_H_

#include <CLI/App.hpp>
#include <optional>
#include <string>

#include "absl/status/statusor.h"
#include "ricochet/scene.h"

namespace google::protobuf {
class Message;
}

namespace ricochet::cli {

// --scene FILE, or a pendulum by flags. Values are kept as typed until they are read.
struct SceneOptions {
  std::string file;
  std::optional<std::string> a, b, inertia, omega;
  std::optional<std::string> mu, mu_static;
  std::optional<std::string> newton, poisson, energetic;

  bool any() const;
};

void AddSceneOptions(CLI::App& app, SceneOptions& options);

// The scene that the options describe; inertia 1 kg m² and w- = -1 rad/s unless given. Not validated.
// Errors: INVALID_ARGUMENT for neither or both of file and flags, a text that is not a number, an unreadable file.
absl::StatusOr<Scene> ReadScene(const SceneOptions& options);

// The whole of a file, or of standard input for "-". Errors: INVALID_ARGUMENT that names the file.
absl::StatusOr<std::string> ReadText(const std::string& path);

// Reads a message of any type from a file, or from standard input for "-". *.json is JSON, *.textproto, *.txtpb and
// *.pbtxt are textproto, anything else is JSON if it starts with a brace.
// Errors: INVALID_ARGUMENT that names the file, and the line where the parser tells it.
absl::Status ReadMessage(const std::string& path, google::protobuf::Message& message);
// The same of a file's text.
absl::Status ParseMessage(const std::string& path, const std::string& text, google::protobuf::Message& message);

}  // namespace ricochet::cli

#endif  // RICOCHET_CLIENT_CLI_SCENE_INPUT_H_
