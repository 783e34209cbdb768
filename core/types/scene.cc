#include "ricochet/scene.h"

#include "ricochet/derivatives.h"

namespace ricochet {

bool TakesTime(const Scene& scene) {
  return scene.compliance.has_value() && !std::holds_alternative<std::monostate>(scene.compliance->normal);
}

const char* WhyNotExact(const Scene& scene) {
  if (TangentialDirections(scene.system) == 2) return "an impact in space";
  if (!std::holds_alternative<std::monostate>(scene.impact_law)) return "an impact law";
  if (!scene.compliance.has_value()) return nullptr;
  return TakesTime(scene) ? "compliance, with which an impact takes time" : "tangential compliance";
}

}  // namespace ricochet
