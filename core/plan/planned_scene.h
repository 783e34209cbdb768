// PlannedScene: a scene reduced to its contact, with the model that is chosen for it.

#ifndef RICOCHET_CORE_PLAN_PLANNED_SCENE_H_
#define RICOCHET_CORE_PLAN_PLANNED_SCENE_H_

#include <optional>
#include <variant>

#include "core/contact/scene_contact.h"
#include "core/models/pendulum/pendulum.h"
#include "core/plan/choose.h"
#include "core/plan/demand.h"
#include "ricochet/outcome.h"
#include "ricochet/scene.h"

namespace ricochet {

struct PlannedScene {
  // A pendulum over a surface at rest keeps its own numbers; any other system is reduced to its contact.
  std::variant<pendulum::Problem, PlanarReduction, SpatialReduction> contact;
  // The contact of a pendulum with compliance, whose closed form does not serve in time.
  std::optional<PlanarReduction> reduced_pendulum;
  EffectiveCoefficients effective;
  ContactPhysics physics;
  Choice choice;
};

// Plans a valid scene and a demand in which CheckDemand finds nothing. Under an impact law the model is kImpactLaw and
// no effect is planned. If doubles cannot represent W or the contact velocity, the model is kUnspecified.
PlannedScene PlanScene(const Scene& scene, std::optional<SceneContact> contact, const Demand& demand);

// The plan in words.
Plan Explain(const PlannedScene& planned, const Demand& demand);

}  // namespace ricochet

#endif  // RICOCHET_CORE_PLAN_PLANNED_SCENE_H_
