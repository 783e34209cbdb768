#include "core/scene/rigid.h"

#include <variant>

#include "absl/strings/str_cat.h"
#include "core/contact/reduction.h"

namespace ricochet {
namespace {

// Compliance is for planar scenes alone.
bool IsCoupled(const Scene& scene) { return std::get<PlanarReduction>(Reduce(scene)).w[1] != 0.0; }

}  // namespace

void RequireRigid(const Scene& scene, RigidIn directions, const char* purpose, std::vector<Violation>& violations) {
  if (!scene.compliance.has_value()) return;
  const auto refuse = [&](const char* field) {
    violations.push_back(MakeViolation(field, "is set", absl::StrCat("not be, ", purpose, " of a rigid contact")));
  };
  const bool has_tangential = scene.compliance->tangential_ratio_squared.has_value();
  if (has_tangential && (directions == RigidIn::kBothDirections || IsCoupled(scene))) {
    refuse("compliance.tangential_ratio_squared");
  }
  const bool has_spring = !std::holds_alternative<std::monostate>(scene.compliance->normal);
  const bool has_forces = !std::holds_alternative<std::monostate>(scene.finite_forces);
  if (has_spring && has_forces) refuse("finite_forces");
}

}  // namespace ricochet
