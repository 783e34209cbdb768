// PlannedScene: the model that is chosen for a scene, and what it needs besides the scene's contact.

#ifndef RICOCHET_CORE_PLAN_PLANNED_SCENE_H_
#define RICOCHET_CORE_PLAN_PLANNED_SCENE_H_

#include <optional>

#include "core/contact/scene_contact.h"
#include "core/models/pendulum/pendulum.h"
#include "core/plan/choose.h"
#include "core/plan/demand.h"
#include "ricochet/outcome.h"
#include "ricochet/plan.h"
#include "ricochet/scene.h"

namespace ricochet {

struct PlannedScene {
  // The pendulum's own problem, if a closed form answers it. Any other system is answered from its contact.
  std::optional<pendulum::Problem> closed_form;
  EffectiveCoefficients effective;
  ContactPhysics physics;
  Choice choice;
};

// Plans a valid scene and a demand in which CheckDemand finds nothing. Unless a closed form answers the scene, `contact`
// is set if it was not yet. Under an impact law the model is kImpactLaw and no effect is planned. If doubles cannot
// represent W or the contact velocity, the model is kUnspecified.
PlannedScene PlanScene(const Scene& scene, std::optional<SceneContact>& contact, const Demand& demand);

// The arithmetic that the chosen model calls for. Only the impact itself can tell, so that a closed form is computed.
PlannedArithmetic ArithmeticOf(const Scene& scene, const std::optional<SceneContact>& contact,
                               const PlannedScene& planned, const Demand& demand);

// Writes the plan in words. Its arithmetic, which is known once the impact is computed, is left as it is; a model that
// has only one gets it.
void Explain(const PlannedScene& planned, const Demand& demand, Plan& plan);

}  // namespace ricochet

#endif  // RICOCHET_CORE_PLAN_PLANNED_SCENE_H_
