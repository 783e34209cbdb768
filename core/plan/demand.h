// Demand: how exact an answer has to be, and what the caller wants in it or out of it by all means.

#ifndef RICOCHET_CORE_PLAN_DEMAND_H_
#define RICOCHET_CORE_PLAN_DEMAND_H_

#include <vector>

#include "core/plan/effect_set.h"
#include "ricochet/error.h"
#include "ricochet/scene.h"

namespace ricochet {

struct Demand {
  // Of each contact velocity after the impact and each impulse times its mobility, over max(|u0|, |v0|); in [0, 0.1].
  // 0: nothing is left out but what changes nothing.
  double relative_tolerance = 1e-12;
  EffectSet required;  // Simulated, even if negligible.
  EffectSet excluded;  // Left out, whatever that changes, and what lives on them too: see WithImplied.
  friend bool operator==(const Demand&, const Demand&) = default;
};

// What is nothing without friction.
inline constexpr EffectSet kOnFriction = {Effect::kSlipStop, Effect::kSlipTurn, Effect::kStaticFriction,
                                          Effect::kTangentialCompliance, Effect::kHigherOrder};

// What leaving out `excluded` leaves out:
//   friction         with all that it does: slip that stops and turns, static friction, tangential compliance, and what
//                    lies beyond first order in x
//   slip that stops  with sticking: static friction, tangential compliance; in space slip that turns, because what
//                    is left is slip along a straight line
//   slip that turns  in space, for the same reason: slip that stops and static friction
//   finite duration  with the finite forces, which need time to act
EffectSet WithImplied(EffectSet excluded, bool in_space);

// Every reason why the demand cannot be met for a valid scene; empty if it can. Paths are "relative_tolerance" and
// "required[i]", "excluded[i]", i counting a set's effects in order of their numbers.
std::vector<Violation> CheckDemand(const Scene& scene, const Demand& demand);

// "slip_stop", as the proto spells it without its prefix.
const char* NameOf(Effect effect);

}  // namespace ricochet

#endif  // RICOCHET_CORE_PLAN_DEMAND_H_
