#include "client/cli/input/derivative_input.h"

#include <utility>

#include "absl/strings/str_cat.h"
#include "client/cli/input/command_options.h"
#include "client/cli/input/short_name.h"
#include "core/base/try.h"

namespace ricochet::cli {

void AddDerivativeOptions(CLI::App& sub, const std::string& numbers, DerivativeOptions& options) {
  AddList(sub, "--derivatives", options.of,
          absl::StrCat("Also print the derivatives of these ", numbers, " by those of --by"))
      ->type_name("OF,...");
  AddList(sub, "--by", options.by, "The numbers of the scene that --derivatives lets change")->type_name("BY,...");
}

absl::StatusOr<std::optional<DerivativePaths>> ReadDerivatives(const DerivativeOptions& options, const Scene& scene,
                                                               const std::vector<std::string>& known) {
  if (!options.any()) return std::nullopt;
  if (options.of.empty() || options.by.empty()) {
    return absl::InvalidArgumentError(options.thresholds ? "--thresholds needs --derivatives OF,... and --by BY,..."
                                                         : "--derivatives OF,... and --by BY,... need each other");
  }
  DerivativePaths paths = {.of = {}, .by = {}, .find_thresholds = options.thresholds};
  for (const std::string& name : options.of) {
    RICOCHET_TRY(std::string of, FullName(name, known, "--derivatives"));
    paths.of.push_back(std::move(of));
  }
  for (const std::string& name : options.by) {
    RICOCHET_TRY(std::string by, FullField(scene, name, "--by"));
    paths.by.push_back(std::move(by));
  }
  return paths;
}

}  // namespace ricochet::cli
