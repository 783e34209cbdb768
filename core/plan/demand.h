// Demand: how exact an answer has to be, and which effects the caller requires or excludes.

#ifndef RICOCHET_CORE_PLAN_DEMAND_H_
#define RICOCHET_CORE_PLAN_DEMAND_H_

#include <optional>
#include <string>
#include <vector>

#include "core/contact/scene_contact.h"
#include "core/plan/effect_set.h"
#include "ricochet/demand.h"
#include "ricochet/error.h"
#include "ricochet/scene.h"

namespace ricochet {

struct Demand {
  // Tolerated change of each contact velocity after the impact and of each impulse times its mobility, in [0, 0.1]: by
  // effects left out over |v0|, by errors of the computation over max(|u0|, |v0|). With 0, an effect is left out only
  // if it changes nothing.
  double relative_tolerance = 1e-12;
  EffectSet required;  // Effects to simulate even if they are negligible.
  EffectSet excluded;  // Effects to leave out whatever that changes; WithImplied adds those that depend on them.

  // True if no effect is required or excluded.
  bool IsToleranceAlone() const { return required.IsEmpty() && excluded.IsEmpty(); }
  friend bool operator==(const Demand&, const Demand&) = default;
};

// Returns what a request demands of accuracy and effects.
Demand ToDemand(const DemandFields& fields);

// These effects do not exist without friction.
inline constexpr EffectSet kOnFriction = {Effect::kSlipStop, Effect::kSlipTurn, Effect::kStaticFriction,
                                          Effect::kTangentialCompliance, Effect::kHigherOrder};

// The effects that are left out if the caller excludes `excluded`:
//   friction         takes with it slip that stops and turns, static friction, tangential compliance, and the terms
//                    beyond first order in x
//   slip that stops  takes with it static friction and tangential compliance; in space also slip that turns, because
//                    slip along a straight line is all that is left
//   slip that turns  takes with it, in space and for the same reason, slip that stops and static friction
//   finite duration  takes with it the finite forces, which need time to act
EffectSet WithImplied(EffectSet excluded, bool in_space);

// Lists every reason why the demand cannot be met for a valid scene; the list is empty if it can. Paths are
// "relative_tolerance", "required[i]" and "excluded[i]", where i counts the effects of a set in order of their numbers.
std::vector<Violation> CheckDemand(const Scene& scene, std::optional<SceneContact>& contact, const Demand& demand);

// Lists what is wrong with the fields of a request whatever the scene, which may break its own rules.
std::vector<Violation> CheckDemand(const DemandFields& fields);

// Lists the same as CheckDemand for ToDemand(fields), with the places that the effects have in the fields.
std::vector<Violation> CheckDemand(const Scene& scene, std::optional<SceneContact>& contact,
                                   const DemandFields& fields);

// Lists the excluded effects without which no model solves a valid scene: a contact whose slip cannot be a straight
// line, a pendulum beyond first order. The list is empty if a model does, or if doubles cannot represent the contact.
std::vector<Violation> CheckSolvableWithout(const Scene& scene, std::optional<SceneContact>& contact,
                                            const Demand& demand);

// The part that the scene lacks for the effect: "a normal spring in compliance"; empty if it lacks nothing.
std::string MissingPart(const Scene& scene, Effect effect);

// The name of the effect in the proto, in small letters and without its prefix: "slip_stop".
const char* NameOf(Effect effect);

}  // namespace ricochet

#endif  // RICOCHET_CORE_PLAN_DEMAND_H_
