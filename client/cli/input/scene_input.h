// Reads scenes from files and from flags.

#ifndef RICOCHET_CLIENT_CLI_INPUT_SCENE_INPUT_H_
#define RICOCHET_CLIENT_CLI_INPUT_SCENE_INPUT_H_

#include <fstream>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "absl/status/statusor.h"
#include "absl/types/span.h"
#include "ricochet/multi_contact.h"
#include "ricochet/scene.h"

namespace CLI {
class App;
}

namespace google::protobuf {
class Message;
}

namespace ricochet::cli {

// The options of a scene: --scene FILE, or the flags of a pendulum, or --mechanism FILE with those of friction and
// restitution. Values are kept as typed until they are read.
struct SceneOptions {
  std::string file;
  std::string mechanism;
  std::vector<std::string> kept;  // Coordinates of the mechanism.
  bool composite = false;
  std::optional<std::string> a, b, inertia, omega;
  std::optional<std::string> mu, mu_static;
  std::optional<std::string> newton, poisson, energetic;

  bool any() const;
};

// A flag of a pendulum.
struct SceneFlag {
  const char* name;
  std::optional<std::string> SceneOptions::*value;
  const char* field;  // The path of the number that it sets.
  const char* help;
};
absl::Span<const SceneFlag> SceneFlags();

void AddSceneOptions(CLI::App& app, SceneOptions& options);
// Adds the options that ReadAnyScene reads.
void AddAnySceneOptions(CLI::App& app, SceneOptions& options);
// --mechanism FILE, --keep and --composite.
void AddMechanismOptions(CLI::App& app, SceneOptions& options);
// Reads these. Errors: INVALID_ARGUMENT.
absl::StatusOr<Mechanism> ReadHeldMechanism(const SceneOptions& options, int64_t contacts);

// Returns the scene that the options describe, without validating it. A pendulum's inertia is 1 kg m² and its w- is
// -1 rad/s unless given.
// Errors: INVALID_ARGUMENT for neither or several of a scene, a mechanism and a pendulum, a text that is not a number,
// an unreadable file.
absl::StatusOr<Scene> ReadScene(const SceneOptions& options);

// Reads the same, or what a file holds that has several contacts. Errors: those of ReadScene.
absl::Status ReadAnyScene(const SceneOptions& options, std::variant<Scene, MultiContactScene>& scene);

// Returns INVALID_ARGUMENT, with the fields that may hold one, for a scene that states no velocity at all. Such a scene
// is valid and nothing happens in it, so that the user has most likely forgotten something.
absl::Status RequireVelocity(const Scene& scene);

// Returns the whole text of a file, or of standard input for "-", without a byte order mark in front of it.
// Errors: INVALID_ARGUMENT that names the file.
absl::StatusOr<std::string> ReadText(const std::string& path);

// Opens a file that is no directory. Errors: INVALID_ARGUMENT that names the file.
absl::StatusOr<std::ifstream> OpenToRead(const std::string& path);

// Returns an error that names the path if the stream, which is that of the file or standard input, ended because it
// could not be read.
absl::Status CheckWholeRead(const std::istream& stream, const std::string& path);

// Reads a message of any type from a file, or from standard input for "-" (proto/text/message_text.h).
// Errors: INVALID_ARGUMENT that names the file, and the line if the parser tells it.
absl::Status ReadMessage(const std::string& path, google::protobuf::Message& message);
// Reads a message from the text of the file `path`, likewise.
absl::Status ParseMessage(const std::string& path, const std::string& text, google::protobuf::Message& message);
// Reads a message from JSON; `name` is what the error calls the text. Errors: INVALID_ARGUMENT.
absl::Status ParseJson(const std::string& name, const std::string& text, google::protobuf::Message& message);

}  // namespace ricochet::cli

#endif  // RICOCHET_CLIENT_CLI_INPUT_SCENE_INPUT_H_
