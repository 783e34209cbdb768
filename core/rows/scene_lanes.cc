#include "core/rows/scene_lanes.h"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <limits>

#include "absl/strings/match.h"
#include "core/rows/pendulum_lanes.h"
#include "core/rows/planar_body_lanes.h"
#include "core/rows/planar_lanes.h"

namespace ricochet {

std::unique_ptr<SceneLanes> SceneLanes::Make(const Scene& scene, absl::Span<const std::string> columns,
                                             const Demand& demand) {
  if (auto pendulum = PendulumLanes::Make(scene, columns, demand)) return pendulum;
  if (auto contact = PlanarLanes::Make(scene, columns, demand)) return contact;
  return PlanarBodyLanes::Make(scene, columns, demand);
}

std::optional<size_t> SceneLanes::NumberAt(const std::string& path) const {
  if (absl::StartsWith(path, "restitution.")) return paths_.size();
  const auto found = std::find(paths_.begin(), paths_.end(), path);
  if (found == paths_.end()) return std::nullopt;
  return static_cast<size_t>(found - paths_.begin());
}

bool KeepCoefficientRules(double mu, double mu_static, RestitutionLaw law, double coefficient) {
  const double most = law == RestitutionLaw::kEnergetic ? 1.0 : std::numeric_limits<double>::max();
  return mu >= 0.0 && mu_static >= mu && coefficient >= 0.0 && coefficient <= most;
}

bool AreFinite(absl::Span<double* const> columns, size_t first, size_t count) {
  // Added to a magnitude, the least exponent carries into the sign if the number is infinite or NaN.
  constexpr uint64_t kSign = uint64_t{1} << 63;
  constexpr uint64_t kLeastExponent = uint64_t{1} << 52;
  uint64_t carry = 0;
  for (const double* const column : columns) {
    for (size_t i = first; i < first + count; ++i)
      carry |= (std::bit_cast<uint64_t>(column[i]) & ~kSign) + kLeastExponent;
  }
  return (carry & kSign) == 0;
}

bool IsPlain(const Scene& scene) {
  Scene plain;
  plain.system = scene.system;
  plain.friction.kinetic_coefficient = scene.friction.kinetic_coefficient;
  plain.friction.static_coefficient = scene.friction.static_coefficient;
  plain.restitution = scene.restitution;
  return scene == plain;
}

}  // namespace ricochet
