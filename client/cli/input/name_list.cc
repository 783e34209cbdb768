#include "client/cli/input/name_list.h"

#include "absl/status/statusor.h"
#include "absl/strings/str_cat.h"
#include "client/cli/input/command_options.h"

namespace ricochet::cli {

bool AsksForNames(const std::vector<std::string>& values) { return values == std::vector<std::string>{"?"}; }

absl::Status ListNames(const SceneOptions& options, std::vector<std::string> (*names_of)(const Scene&)) {
  const absl::StatusOr<Scene> scene = options.any() ? ReadScene(options) : Scene{.system = Pendulum()};
  if (!scene.ok()) return scene.status();
  std::string text;
  for (const std::string& name : names_of(*scene)) absl::StrAppend(&text, name, "\n");
  return WriteOutput({}, text);
}

}  // namespace ricochet::cli
