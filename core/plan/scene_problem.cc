#include "core/plan/scene_problem.h"

#include <algorithm>
#include <variant>

#include "core/contact/coefficients_at_speed.h"
#include "core/models/restitution_law.h"

namespace ricochet {
namespace {

double PendulumSpeed(const Pendulum& pendulum) { return std::max(0.0, -pendulum.a_m * pendulum.omega_minus_rad_s); }

}  // namespace

bool HasClosedForm(const Scene& scene) {
  return std::holds_alternative<Pendulum>(scene.system) && !scene.surface_velocity.has_value() &&
         std::holds_alternative<std::monostate>(scene.impact_law);
}

pendulum::Problem ClosedFormProblem(const Scene& scene) {
  pendulum::Problem problem = pendulum::MakeProblem(scene);
  if (!DependsOnSpeed(scene)) return problem;
  const EffectiveCoefficients effective = CoefficientsAtSpeed(scene, PendulumSpeed(std::get<Pendulum>(scene.system)));
  problem.mu = effective.kinetic_friction;
  problem.mu_static = effective.static_friction;
  problem.coefficient = effective.restitution.value_or(0.0);
  return problem;
}

namespace pendulum {

Problem MakeProblem(const Scene& scene) {
  const auto& pendulum = std::get<Pendulum>(scene.system);
  const StatedRestitution stated = LawAndCoefficientOf(scene.restitution);
  return {.inertia = pendulum.inertia_kg_m2,
          .a = pendulum.a_m,
          .b = pendulum.b_m,
          .omega_minus = pendulum.omega_minus_rad_s,
          .mu = scene.friction.kinetic_coefficient,
          .mu_static = scene.friction.static_coefficient.value_or(scene.friction.kinetic_coefficient),
          .law = stated.law,
          .coefficient = stated.coefficient};
}

}  // namespace pendulum

namespace planar {

Problem MakeProblem(const PlanarReduction& reduction, const Restitution& restitution,
                    const EffectiveCoefficients& effective) {
  return {.w = {reduction.w[0], reduction.w[1], reduction.w[2]},
          .u0 = reduction.u0[0],
          .v0 = reduction.v0,
          .mu = effective.kinetic_friction,
          .mu_static = effective.static_friction,
          .law = LawAndCoefficientOf(restitution).law,
          .coefficient = effective.restitution.value_or(0.0)};
}

}  // namespace planar

namespace spatial {

Problem MakeProblem(const SpatialReduction& reduction, const Restitution& restitution,
                    const EffectiveCoefficients& effective, double tolerance) {
  const auto& [w11, w12, w13, w22, w23, w33] = reduction.w;
  return {.w11 = w11,
          .w12 = w12,
          .w13 = w13,
          .w22 = w22,
          .w23 = w23,
          .w33 = w33,
          .u0 = reduction.u0,
          .v0 = reduction.v0,
          .mu = effective.kinetic_friction,
          .mu_static = effective.static_friction,
          .law = LawAndCoefficientOf(restitution).law,
          .coefficient = effective.restitution.value_or(0.0),
          .tolerance = tolerance};
}

}  // namespace spatial
}  // namespace ricochet
