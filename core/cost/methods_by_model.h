// The methods of each kind of model: the parts of StudyScene (core/cost/cost_methods.h).

#ifndef RICOCHET_CORE_COST_METHODS_BY_MODEL_H_
#define RICOCHET_CORE_COST_METHODS_BY_MODEL_H_

#include <cstddef>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "core/cost/cost_methods.h"
#include "core/models/pendulum/pendulum.h"
#include "core/models/planar/planar.h"
#include "core/models/sliding/sliding.h"
#include "core/models/spatial/spatial.h"
#include "core/plan/choose.h"
#include "core/plan/demand.h"
#include "core/plan/sizes.h"
#include "ricochet/plan.h"
#include "ricochet/scene.h"

namespace ricochet {

using Methods = std::vector<StudiedMethod>;
using ReferencePointer = std::shared_ptr<Reference>;

// The error of a reference that is not known.
inline constexpr double kNotKnown = std::numeric_limits<double>::infinity();

inline constexpr char kNotProved[] =
    "Plain arithmetic cannot prove a sign or its error bound for this scene; a plan then takes compensated arithmetic.";

inline ReferencePointer MakeReference(Reference::Compute compute) {
  return std::make_shared<Reference>(std::move(compute));
}

// The demand that leaves out every effect that `model` does not simulate, and nothing else.
Demand DemandFor(Model model);

// The sum of the sizes of all effects that `model` leaves out, over V; infinite where no bound is known.
double NeglectedBy(Model model, const pendulum::Problem& problem, const ContactPhysics& physics);
double NeglectedBy(Model model, const planar::Problem& problem, const ContactPhysics& physics);

// The name of an arithmetic: "plain".
std::string NameOf(Arithmetic arithmetic);

// The frictionless and the first-order forms of a pendulum, and its closed form. `exact` is the exact rigid impact,
// here and below.
void AddClosedForms(const pendulum::Problem& problem, const ContactPhysics& physics, const ReferencePointer& exact,
                    Methods& methods);

// Paths of one piece: the model is kFrictionless or kSliding. `choice` is the plan's for DemandFor the model; no method
// is added if it took another model.
template <size_t kTangential>
void AddStraight(Model model, const sliding::Problem<kTangential>& problem, const Choice& choice, Methods& methods);

// The planar model. `reduction_error` is what the rounding of W adds to its claims.
void AddPlanar(const planar::Problem& problem, const ContactPhysics& physics, const ReferencePointer& exact,
               double reduction_error, Methods& methods);

// Certified digits of a rigid impact: those of `scene`, which SceneOf made (core/cost/reference_velocity.h).
void AddCertified(const Scene& scene, double speed, double claimed_modelling, const ReferencePointer& exact,
                  Methods& methods);

// Returns the exact answer.
ReferencePointer AddCompliant(const planar::Problem& problem, const ContactPhysics& physics, Methods& methods);

// The stiffness of a spring in its own unit; 0 if there is none.
double StiffnessOf(const NormalSpring& spring);

// `impulses` is the exact answer where the spring changes no impulse: that of the rigid contact, or of the compliant
// one; null if finite forces or damping act. Then the answer at the smallest tolerance is taken. Returns the exact
// answer at the stiffness of the scene's own spring; null if it has none.
ReferencePointer AddFiniteDuration(const planar::Problem& problem, const ContactPhysics& physics,
                                   const ReferencePointer& impulses, Methods& methods);

void AddSpatial(const spatial::Problem& problem, const ReferencePointer& exact, Methods& methods);

void AddImpactLaw(const ImpactLaw& law, const planar::Problem& problem, Methods& methods);

}  // namespace ricochet

#endif  // RICOCHET_CORE_COST_METHODS_BY_MODEL_H_
