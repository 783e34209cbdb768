// PlannedScene: the model that is chosen for a scene, and the problem that it is to solve.

#ifndef RICOCHET_CORE_PLAN_PLANNED_SCENE_H_
#define RICOCHET_CORE_PLAN_PLANNED_SCENE_H_

#include <optional>
#include <variant>

#include "core/contact/scene_contact.h"
#include "core/models/pendulum/pendulum.h"
#include "core/models/planar/planar.h"
#include "core/models/spatial/spatial.h"
#include "core/plan/choose.h"
#include "core/plan/demand.h"
#include "ricochet/outcome.h"
#include "ricochet/plan.h"
#include "ricochet/scene.h"

namespace ricochet {

struct PlannedScene {
  // A pendulum's own problem if a form of the pendulum answers it, else that of the contact. The effects that the
  // choice leaves out are left out of it. std::monostate if there is no model.
  std::variant<std::monostate, pendulum::Problem, planar::Problem, spatial::Problem> problem;
  ContactPhysics physics;           // Set for a contact in a plane; it lacks these effects, too.
  EffectiveCoefficients effective;  // The coefficients of the scene with all effects.
  Choice choice;
  Demand demand;  // The demand that the scene was planned for.

  // The part of the tolerance that the effects left out do not use.
  double ToleranceLeft() const;
};

// The parts of a planar scene beyond the rigid impact.
ContactPhysics PhysicsOf(const Scene& scene, const PlanarReduction& reduction);

// Plans a valid scene and a demand in which CheckDemand finds nothing. Unless a form of the pendulum answers the scene,
// `contact` is set if it was not yet. Under an impact law the model is kImpactLaw and no effect is planned. If doubles
// cannot represent W or the contact velocity, the model is kUnspecified.
PlannedScene PlanScene(const Scene& scene, std::optional<SceneContact>& contact, const Demand& demand);

// The arithmetic that the chosen model calls for. Only the impact itself can tell, so that a closed form is computed.
PlannedArithmetic ArithmeticOf(const PlannedScene& planned);

// Writes the plan in words. Its arithmetic, which is known once the impact is computed, is left as it is; a model that
// has only one gets it.
void Explain(const PlannedScene& planned, Plan& plan);

}  // namespace ricochet

#endif  // RICOCHET_CORE_PLAN_PLANNED_SCENE_H_
