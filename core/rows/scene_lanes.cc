#include "core/rows/scene_lanes.h"

#include <bit>
#include <cstdint>
#include <limits>

namespace ricochet {
namespace {

// The system and the coefficients of friction and restitution, and nothing else.
Scene PlainPart(const Scene& scene) {
  return {.system = scene.system,
          .friction = {.kinetic_coefficient = scene.friction.kinetic_coefficient,
                       .static_coefficient = scene.friction.static_coefficient},
          .restitution = scene.restitution};
}

// The part of a scene that has the numbers of the lanes: it states static friction, too.
Scene NumberedPart(const Scene& scene) {
  Scene part = PlainPart(scene);
  part.friction.static_coefficient = scene.friction.static_coefficient.value_or(scene.friction.kinetic_coefficient);
  return part;
}

}  // namespace

std::unique_ptr<SceneLanes> SceneLanes::Make(const Scene& scene, absl::Span<const std::string> columns,
                                             const Demand& demand) {
  if (auto pendulum = MakePendulumLanes(scene, columns, demand)) return pendulum;
  if (auto contact = MakePlanarLanes(scene, columns, demand)) return contact;
  return MakePlanarBodyLanes(scene, columns, demand);
}

std::vector<std::string> SceneLanes::PathsOf(const Scene& scene) {
  std::vector<std::string> paths;
  const Scene part = NumberedPart(scene);
  VisitNumbers(
      part, [&paths](const NumberPath& path, double /*number*/, NumberRule /*rule*/) { paths.push_back(path.Text()); });
  return paths;
}

SceneLanes::Numbers SceneLanes::NumbersOf(const Scene& scene) const {
  Numbers numbers = {};
  const Scene part = NumberedPart(scene);
  VisitNumbers(part, [next = numbers.data()](const NumberPath& /*path*/, double number, NumberRule /*rule*/) mutable {
    *next++ = number;
  });
  return numbers;
}

bool KeepCoefficientRules(double mu, double mu_static, RestitutionLaw law, double coefficient) {
  const double most = law == RestitutionLaw::kEnergetic ? 1.0 : std::numeric_limits<double>::max();
  return mu >= 0.0 && mu_static >= mu && coefficient >= 0.0 && coefficient <= most;
}

bool AreFinite(absl::Span<double* const> columns, size_t first, size_t count) {
  // Adding one exponent step to the bits of a magnitude sets the sign bit only if the number is infinite or NaN.
  constexpr uint64_t kSign = uint64_t{1} << 63;
  constexpr uint64_t kLeastExponent = uint64_t{1} << 52;
  uint64_t carry = 0;
  for (const double* const column : columns) {
    for (size_t i = first; i < first + count; ++i)
      carry |= (std::bit_cast<uint64_t>(column[i]) & ~kSign) + kLeastExponent;
  }
  return (carry & kSign) == 0;
}

bool IsPlain(const Scene& scene) { return scene == PlainPart(scene); }

}  // namespace ricochet
