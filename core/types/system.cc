#include "ricochet/system.h"

namespace ricochet {

size_t TangentialDirections(const Mechanism& mechanism) {
  return !mechanism.rates.empty() && mechanism.jacobian.size() == 3 * mechanism.rates.size() ? 2 : 1;
}

bool HoldsCoordinates(const System& system) {
  const auto* const mechanism = std::get_if<Mechanism>(&system);
  return mechanism != nullptr && (mechanism->composite || !mechanism->kept_coordinates.empty());
}

size_t TangentialDirections(const System& system) {
  if (const auto* pair = std::get_if<BodyPair>(&system))
    return std::holds_alternative<SpatialPair>(pair->bodies) ? 2 : 1;
  if (const auto* mechanism = std::get_if<Mechanism>(&system)) return TangentialDirections(*mechanism);
  return std::holds_alternative<SpatialBody>(system) || std::holds_alternative<SpatialContact>(system) ? 2 : 1;
}

}  // namespace ricochet
