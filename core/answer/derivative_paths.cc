#include "core/answer/derivative_paths.h"

#include <algorithm>
#include <array>
#include <cstddef>

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/strip.h"
#include "core/answer/derivative_sides.h"
#include "core/base/nearest.h"
#include "core/models/planar_outputs.h"
#include "core/scene/field.h"

namespace ricochet {
namespace {

std::vector<std::string> OutputPaths(const Scene& scene) {
  const size_t tangential = TangentialDirections(scene.system);
  std::vector<std::string> paths;
  for (const std::string path : kPlanarOutputPaths) {
    paths.push_back(path);
    if (tangential == 2 && absl::EndsWith(path, "[0]"))
      paths.push_back(absl::StrCat(absl::StripSuffix(path, "0]"), "1]"));
  }
  const std::vector<std::string> linear = LinearNumberPaths(scene.system);
  paths.insert(paths.end(), linear.begin(), linear.end());
  if (TakesTime(scene)) {
    for (const char* number : {"duration_s", "peak_normal_n", "peak_tangential_n", "indentation_m"}) {
      paths.push_back(absl::StrCat("contact.", number));
    }
  }
  return paths;
}

const char* StatedDefinition(const Scene& scene) {
  constexpr std::array kDefinitions = {"", "restitution.newton", "restitution.poisson", "restitution.energetic"};
  return kDefinitions[scene.restitution.index()];
}

bool IsOtherDefinition(const Scene& scene, const std::string& path) {
  return absl::StartsWith(path, "restitution.") && !absl::StartsWith(path, "restitution.by_speed.") &&
         path != StatedDefinition(scene);
}

}  // namespace

void CheckPaths(const char* list, const std::vector<std::string>& paths, const std::vector<std::string>& known,
                const char* what, std::vector<Violation>& violations) {
  if (paths.empty())
    violations.push_back(MakeViolation(absl::StrCat("derivatives.", list), "is empty", "name a number"));
  for (size_t i = 0; i < paths.size(); ++i) {
    if (std::find(known.begin(), known.end(), paths[i]) != known.end()) continue;
    violations.push_back(MakeViolation(absl::StrCat("derivatives.", list, "[", i, "]"), Found(paths[i]),
                                       absl::StrCat("be ", what, DidYouMean(paths[i], known))));
  }
}

DerivativePaths AllDerivativePaths(const Scene& scene) {
  DerivativePaths paths = {.of = OutputPaths(scene), .by = AllFieldPaths(scene)};
  std::erase_if(paths.by, [&scene](const std::string& path) { return IsOtherDefinition(scene, path); });
  return paths;
}

std::vector<Violation> CheckDerivatives(const Scene& scene, const DemandFields& demand, const DerivativePaths& paths) {
  std::vector<Violation> violations;
  if (!demand.excluded.empty()) {
    violations.push_back(MakeViolation("excluded", "is set", "not be, with derivatives: they leave nothing out"));
  }
  const DerivativePaths known = AllDerivativePaths(scene);
  CheckPaths(
      "of", paths.of, known.of,
      "a coefficient, an impulse, a contact velocity, a velocity or momentum of the system, or a work other than "
      "that of a spring",
      violations);
  CheckPaths("by", paths.by, known.by, "a number of the scene, with the definition of restitution that it states",
             violations);
  return violations;
}

}  // namespace ricochet
