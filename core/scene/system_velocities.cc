#include "core/scene/system_velocities.h"

#include <cstddef>
#include <variant>

#include "absl/strings/str_cat.h"

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

}  // namespace

std::vector<std::string> SystemVelocityPaths(const System& system) {
  std::vector<std::string> paths;
  std::visit(VelocityPaths{paths, TangentialDirections(system)}, system);
  return paths;
}

}  // namespace ricochet
