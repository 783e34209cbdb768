#include "core/plan/contact_scene.h"

#include "core/models/restitution_law.h"

namespace ricochet {
namespace {

template <typename Problem>
Scene SceneWith(const System& system, const Problem& problem) {
  Scene scene;
  scene.system = system;
  scene.friction = {.kinetic_coefficient = problem.mu, .static_coefficient = problem.mu_static};
  scene.restitution = ToRestitution(problem.law, problem.coefficient);
  return scene;
}

}  // namespace

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
