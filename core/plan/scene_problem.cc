#include "core/plan/scene_problem.h"

#include <algorithm>
#include <variant>

#include "core/contact/scene_contact.h"
#include "core/models/restitution_law.h"

namespace ricochet {
namespace {

double PendulumSpeed(const Pendulum& pendulum) { return std::max(0.0, -pendulum.a_m * pendulum.omega_minus_rad_s); }

template <typename Problem>
Scene SceneWith(const System& system, const Problem& problem) {
  Scene scene;
  scene.system = system;
  scene.friction = {.kinetic_coefficient = problem.mu, .static_coefficient = problem.mu_static};
  scene.restitution = ToRestitution(problem.law, problem.coefficient);
  return scene;
}

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

Scene SceneOf(const pendulum::Problem& problem) {
  return SceneWith(Pendulum{.inertia_kg_m2 = problem.inertia,
                            .a_m = problem.a,
                            .b_m = problem.b,
                            .omega_minus_rad_s = problem.omega_minus},
                   problem);
}

Scene SceneOf(const planar::Problem& problem) {
  return SceneWith(PlanarContact{.w_tt_per_kg = problem.w.tt,
                                 .w_tn_per_kg = problem.w.tn,
                                 .w_nn_per_kg = problem.w.nn,
                                 .tangential_m_s = problem.u0,
                                 .normal_m_s = problem.v0},
                   problem);
}

}  // namespace ricochet
