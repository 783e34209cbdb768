#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <variant>

#include "absl/strings/str_cat.h"
#include "core/base/decimal.h"
#include "core/contact/interval_reduction.h"
#include "core/contact/reduction.h"
#include "core/contact/scene_contact.h"
#include "core/scene/check.h"

namespace ricochet {
namespace {

// The field of the normal velocity.
std::string VelocityField(const Scene& scene) {
  if (scene.surface_velocity.has_value()) return "surface_velocity";
  if (std::holds_alternative<PlanarContact>(scene.system)) return "planar_contact.normal_m_s";
  if (std::holds_alternative<SpatialContact>(scene.system)) return "spatial_contact.normal_m_s";
  return "system";
}

// No impulse along n moves a contact with W_nn = 0: it may not approach.
void CheckMobility(const Scene& scene, const AnyReduction& any, Check& check) {
  std::visit(
      [&](const auto& reduction) {
        check.Require(reduction.v0 >= 0.0 || reduction.w.back() > 0.0, [&] {
          const char* const held = HoldsCoordinates(scene.system) ? "; hold fewer coordinates of the mechanism" : "";
          return MakeViolation(
              VelocityField(scene), absl::StrCat("makes v0 = ", ShortestDecimal(reduction.v0), " where W_nn = 0"),
              absl::StrCat("be >= 0, no impulse along n ends the approach", held), ViolationKind::kContact);
        });
      },
      any);
}

// The model in space squares friction, too.
void CheckSpread(const Scene& scene, const SpatialReduction& reduction, const EffectiveCoefficients& effective,
                 Check& check) {
  constexpr double kMostFriction = 1.0 / kLeastShareOfW;
  const auto& [w11, w12, w13, w22, w23, w33] = reduction.w;
  const double largest = std::max({w11, w22, w33});
  const auto field = [&scene] {
    return std::holds_alternative<SpatialContact>(scene.system) ? "spatial_contact.w_per_kg" : "system";
  };
  for (const double own : {w11, w22, w33}) RequireShareOfW(own, largest, field, check);
  // A product that overflows has a violation of its own.
  const double friction = effective.kinetic_friction;
  check.Require(friction <= kMostFriction || !std::isfinite(friction), [&] {
    return MakeViolation("friction", absl::StrCat("has a kinetic coefficient of ", ShortestDecimal(friction)),
                         absl::StrCat("be at most ", ShortestDecimal(kMostFriction), " in space"),
                         ViolationKind::kContact);
  });
}

// `product` is the coefficient times its factor at `speed`.
void CheckProduct(const char* field, double product, double speed, double most, Check& check) {
  check.Require(product >= 0.0 && product <= most && std::isfinite(product), [&] {
    return MakeViolation(field,
                         absl::StrCat("makes the coefficient ", ShortestDecimal(product), " at the approach speed ",
                                      ShortestDecimal(speed), " m/s"),
                         std::isfinite(most) ? "be in [0, 1]" : "be finite and >= 0", ViolationKind::kContact);
  });
}

void CheckEffective(const Scene& scene, const EffectiveCoefficients& effective, double speed, Check& check) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  if (scene.friction.by_speed.has_value()) {
    CheckProduct("friction.by_speed", effective.kinetic_friction, speed, kInfinity, check);
    // The static coefficient may overflow although the kinetic one does not.
    if (std::isfinite(effective.kinetic_friction) && effective.kinetic_friction >= 0.0) {
      CheckProduct("friction.by_speed", effective.static_friction, speed, kInfinity, check);
    }
  }
  if (scene.restitution_by_speed.has_value()) {
    const bool energetic = std::holds_alternative<EnergeticCoefficient>(scene.restitution);
    CheckProduct("restitution.by_speed", effective.restitution.value_or(0.0), speed, energetic ? 1.0 : kInfinity,
                 check);
  }
}

// The energetic coefficient measures the energy that a spring returns. If W_tn = 0, all three coefficients are equal,
// and any of them will do.
void CheckSpring(const Scene& scene, const PlanarReduction& reduction, const EffectiveCoefficients& effective,
                 Check& check) {
  const double tn = std::abs(reduction.w[1]);
  const double nn = reduction.w[2];
  const auto violation = [&scene](const char* found, const char* rule) {
    const char* const path = std::holds_alternative<NewtonCoefficient>(scene.restitution)    ? "restitution.newton"
                             : std::holds_alternative<PoissonCoefficient>(scene.restitution) ? "restitution.poisson"
                                                                                             : "restitution.energetic";
    return MakeViolation(path, found, rule, ViolationKind::kContact);
  };
  if (!std::holds_alternative<EnergeticCoefficient>(scene.restitution)) {
    check.Require(tn == 0.0, [&] {
      return violation("is not energetic", "be, with compliance, unless W_tn is 0 and all three are the same");
    });
    check.Require(effective.restitution.value_or(0.0) <= 1.0,
                  [&] { return violation("is above 1", "be in [0, 1], with compliance"); });
  }
  const bool chatters = scene.compliance->tangential_ratio_squared.has_value() &&
                        effective.restitution.value_or(0.0) == 0.0 && effective.kinetic_friction * tn >= nn &&
                        reduction.v0 < 0.0;
  check.Require(!chatters, [&] {
    return violation("is 0", "be > 0, with a tangential compliance and friction that reaches W_nn/|W_tn|");
  });
}

// True if impulses along n move the contact, or it does not approach, whatever the numbers of the system are.
bool MobilityIsSure(const Scene& scene) { return !scene.surface_velocity.has_value() && IsOfRankOne(scene.system); }

}  // namespace

void CheckContact(const Scene& scene, const AnyReduction* known, Check& check, std::optional<SceneContact>& contact) {
  const bool with_spring = scene.compliance.has_value() && !std::holds_alternative<std::monostate>(scene.restitution);
  if (MobilityIsSure(scene) && !DependsOnSpeed(scene) && !with_spring) return;
  if (known == nullptr) {
    contact.emplace(scene);
  } else {
    contact.emplace(scene, *known);
  }
  const AnyReduction& reduction = contact->reduction;
  // The caller reports an overflow of the reduction, because no single field causes it. A pendulum whose W overflows
  // has a finite speed and is solved without a reduction.
  const bool is_finite = IsFinite(reduction);
  const double speed = ApproachSpeed(reduction);
  if (is_finite && !MobilityIsSure(scene)) CheckMobility(scene, reduction, check);
  const auto* const spatial = std::get_if<SpatialReduction>(&reduction);
  if (is_finite && spatial != nullptr && spatial->v0 < 0.0) {
    CheckSpread(scene, *spatial, contact->coefficients, check);
  }
  if (DependsOnSpeed(scene) && std::isfinite(speed)) CheckEffective(scene, contact->coefficients, speed, check);
  if (is_finite && with_spring) CheckSpring(scene, std::get<PlanarReduction>(reduction), contact->coefficients, check);
}

}  // namespace ricochet
