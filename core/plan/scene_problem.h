// The Problem of each impact model for a scene that has been reduced to its contact (core/contact/reduction.h), and the
// ways back and across: the scene that states a problem, and the same contact for another model.

#ifndef RICOCHET_CORE_PLAN_SCENE_PROBLEM_H_
#define RICOCHET_CORE_PLAN_SCENE_PROBLEM_H_

#include "core/contact/reduction.h"
#include "core/models/pendulum/pendulum.h"
#include "core/models/planar/planar.h"
#include "core/models/sliding/sliding.h"
#include "core/models/spatial/spatial.h"
#include "ricochet/outcome.h"
#include "ricochet/scene.h"

namespace ricochet {

// True if the closed form of the pendulum answers the scene: a pendulum over a surface at rest, without an impact law.
bool HasClosedForm(const Scene& scene);

// Returns the pendulum's problem with the coefficients at the approach speed. `scene` must be valid and HasClosedForm.
pendulum::Problem ClosedFormProblem(const Scene& scene);

namespace pendulum {

// Returns the problem of a scene that states a pendulum. A scene without a coefficient gets kEnergetic, 0.
Problem MakeProblem(const Scene& scene);

}  // namespace pendulum

namespace planar {

// `effective` holds the coefficients, `restitution` says by which law.
Problem MakeProblem(const PlanarReduction& reduction, const Restitution& restitution,
                    const EffectiveCoefficients& effective);

}  // namespace planar

namespace spatial {

// `effective` holds the coefficients, `restitution` says by which law.
Problem MakeProblem(const SpatialReduction& reduction, const Restitution& restitution,
                    const EffectiveCoefficients& effective, double tolerance);

}  // namespace spatial

// Returns the scene that states a model's problem, for code that starts from a scene, such as certificates.
Scene SceneOf(const pendulum::Problem& problem);
Scene SceneOf(const planar::Problem& problem);

// Returns the same contact for the models whose slip neither stops nor turns.
inline sliding::Problem<1> SlidingProblemOf(const planar::Problem& problem) {
  return {.w = {problem.w.tt, problem.w.tn, problem.w.nn},
          .u0 = {problem.u0},
          .v0 = problem.v0,
          .mu = problem.mu,
          .coefficient = problem.coefficient};
}

inline sliding::Problem<2> SlidingProblemOf(const spatial::Problem& problem) {
  return {.w = {problem.w11, problem.w12, problem.w13, problem.w22, problem.w23, problem.w33},
          .u0 = problem.u0,
          .v0 = problem.v0,
          .mu = problem.mu,
          .coefficient = problem.coefficient};
}

}  // namespace ricochet

#endif  // RICOCHET_CORE_PLAN_SCENE_PROBLEM_H_
