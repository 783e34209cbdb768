// Choose: the cheapest model that is proved to answer a contact within a demand.
//
// core/plan/candidates.h has the models in order of cost. The first one is taken for which
//
//   every required effect is simulated, every excluded one is not, and
//   sum of the sizes (core/plan/sizes.h) of the effects left out + the model's own numerical error <= the tolerance.
//
// docs/theory/plan.md, section 2, says how excluded effects count and which contacts a closed form does not serve.
// A choice allocates nothing and costs a few dozen multiplications, because a sweep makes one at every point.
// The problem must be valid. If no model meets the demand, the choice is kUnspecified; this happens exactly if
// CheckDemand (core/plan/demand.h) finds a violation.

#ifndef RICOCHET_CORE_PLAN_CHOOSE_H_
#define RICOCHET_CORE_PLAN_CHOOSE_H_

#include <array>

#include "core/models/impact_errors.h"
#include "core/plan/demand.h"
#include "core/plan/sizes.h"
#include "ricochet/plan.h"

namespace ricochet {

struct Choice {
  Model model = Model::kUnspecified;
  EffectSet left_out;
  double neglected = 0.0;           // Sum of the sizes of all effects left out.
  double negligible = 0.0;          // The part of `neglected` that the plan itself leaves out, and not the caller.
  double model_tolerance = 0.0;     // Tolerance for the spatial model or that of finite duration; 0 for other models.
  RelativeErrors one_piece_errors;  // The model's own errors, if it is kFrictionless or kSliding.
  std::array<Decision, kEffectCount> decisions = {};
  Sizes sizes;
};

Choice ChoosePlanar(const planar::Problem& problem, const ContactPhysics& physics, const Demand& demand);
Choice ChooseSpatial(const spatial::Problem& problem, const Demand& demand);
Choice ChoosePendulum(const pendulum::Problem& problem, const ContactPhysics& physics, const Demand& demand);

// Gives the model that ChoosePendulum chooses for a rigid pendulum and a demand that is a tolerance alone, at a
// fraction of the cost.
Model ModelOfPendulum(const pendulum::Problem& problem, double tolerance);

// Leaves effects out of both coefficients of friction: without friction mu = mu_s = 0, without static friction mu_s =
// mu.
inline void LeaveOut(EffectSet effects, double& mu, double& mu_static) {
  if (effects.Has(Effect::kFriction)) mu = mu_static = 0.0;
  if (effects.Has(Effect::kStaticFriction)) mu_static = mu;
}
// Leaves the effects out of a problem of any model that has both coefficients of friction.
template <typename Problem>
Problem Without(EffectSet effects, Problem problem) {
  LeaveOut(effects, problem.mu, problem.mu_static);
  return problem;
}
ContactPhysics Without(EffectSet effects, ContactPhysics physics);

// Leaves out all effects that the choice leaves out.
template <typename Problem>
Problem Without(const Choice& choice, const Problem& problem) {
  return Without(choice.left_out, problem);
}

}  // namespace ricochet

#endif  // RICOCHET_CORE_PLAN_CHOOSE_H_
