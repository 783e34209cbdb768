#include "ricochet/system.h"

namespace ricochet {

size_t TangentialDirections(const System& system) {
  if (const auto* pair = std::get_if<BodyPair>(&system))
    return std::holds_alternative<SpatialPair>(pair->bodies) ? 2 : 1;
  return std::holds_alternative<SpatialBody>(system) || std::holds_alternative<SpatialContact>(system) ? 2 : 1;
}

}  // namespace ricochet
