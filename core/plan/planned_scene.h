// PlannedScene: a scene as the models see it, and the one that is chosen for it.

#ifndef RICOCHET_CORE_PLAN_PLANNED_SCENE_H_
#define RICOCHET_CORE_PLAN_PLANNED_SCENE_H_

#include <variant>

#include "core/contact/reduction.h"
#include "core/models/pendulum/pendulum.h"
#include "core/plan/choose.h"
#include "core/plan/demand.h"
#include "ricochet/outcome.h"
#include "ricochet/scene.h"

namespace ricochet {

struct PlannedScene {
  // A pendulum over a surface at rest keeps its own numbers; everything else is reduced to its contact.
  std::variant<pendulum::Problem, PlanarReduction, SpatialReduction> contact;
  EffectiveCoefficients effective;
  ContactPhysics physics;
  Choice choice;
};

// `scene` is valid and CheckDemand finds nothing. Under an impact law the model is kImpactLaw and no effect is planned;
// so it is, with kUnspecified, where doubles do not hold W or the contact velocity.
PlannedScene PlanScene(const Scene& scene, const Demand& demand);

// The plan in words.
Plan Explain(const PlannedScene& planned, const Demand& demand);

}  // namespace ricochet

#endif  // RICOCHET_CORE_PLAN_PLANNED_SCENE_H_
