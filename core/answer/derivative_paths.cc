#include "core/answer/derivative_paths.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <variant>

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/strip.h"
#include "core/base/nearest.h"
#include "core/models/planar_outputs.h"
#include "core/scene/field.h"

namespace ricochet {
namespace {

struct VelocityPaths {
  std::vector<std::string>& paths;
  size_t tangential;  // Directions.

  void operator()(std::monostate) const {}
  void operator()(const PlanarContact& /*contact*/) const {}
  void operator()(const SpatialContact& /*contact*/) const {}
  void operator()(const SpatialBody& /*body*/) const { Bodies(1); }
  void operator()(const Pendulum& /*pendulum*/) const { List("rates_after_rad_s", 1); }
  void operator()(const Linkage& linkage) const { List("rates_after_rad_s", linkage.links.size()); }
  void operator()(const Mechanism& mechanism) const { List("rates_after", mechanism.rates.size()); }
  void operator()(const PlanarBody& /*body*/) const { Bodies(1); }
  void operator()(const BodyPair& /*pair*/) const { Bodies(2); }

 private:
  void List(const std::string& name, size_t count) const {
    for (size_t i = 0; i < count; ++i) paths.push_back(absl::StrCat(name, "[", i, "]"));
  }
  void Bodies(int count) const {
    for (int i = 0; i < count; ++i) {
      List(absl::StrCat("bodies_after[", i, "].linear_m_s"), tangential + 1);
      List(absl::StrCat("bodies_after[", i, "].angular_rad_s"), tangential == 1 ? 1 : 3);
    }
  }
};

std::vector<std::string> OutputPaths(const Scene& scene) {
  const size_t tangential = TangentialDirections(scene.system);
  std::vector<std::string> paths;
  for (const std::string path : kPlanarOutputPaths) {
    paths.push_back(path);
    if (tangential == 2 && absl::EndsWith(path, "[0]"))
      paths.push_back(absl::StrCat(absl::StripSuffix(path, "0]"), "1]"));
  }
  const std::vector<std::string> velocities = SystemVelocityPaths(scene);
  paths.insert(paths.end(), velocities.begin(), velocities.end());
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

std::vector<std::string> SystemVelocityPaths(const Scene& scene) {
  std::vector<std::string> paths;
  std::visit(VelocityPaths{paths, TangentialDirections(scene.system)}, scene.system);
  return paths;
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
  CheckPaths("of", paths.of, known.of,
             "a coefficient, an impulse, a contact velocity, a velocity of the system, or a work other than that of a "
             "spring",
             violations);
  CheckPaths("by", paths.by, known.by, "a number of the scene, with the definition of restitution that it states",
             violations);
  return violations;
}

}  // namespace ricochet
