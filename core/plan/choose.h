// Choose: the cheapest model that is proved to answer a contact within a demand.
//
// In order of cost: frictionless, first order (a pendulum's), sliding, a pendulum's closed form, planar, spatial,
// compliant, finite duration. Each simulates some effects and leaves out the others; the first is taken for which
//
//   every required effect is simulated, every excluded one is not, and
//   sum of the sizes (core/plan/sizes.h) of what it leaves out + its own numerical error <= the tolerance.
//
// What the caller excludes does not count: the tolerance is that of the answer without it. Where friction is left out,
// what lives on it is too, at no further price. The last model that simulates all there is counts as exact: its error
// is what double precision or its own tolerance allows. Closed forms in plain double arithmetic (frictionless, first
// order, sliding) do not serve for a coefficient of restitution above 1 or c >= 1 (possible self-locking), frictionless
// and sliding neither for W of rank one, unless Wtt = 0; these have the exact models' care for limits and regimes.
// v0 >= 0 without a spring and finite forces: no model at all, nothing happens.
//
// Everything here is free of allocation and costs a few dozen multiplications: a sweep asks it of every point.
// Bad input: none gets here (CheckDemand). Where no model meets the demand the choice is kUnspecified; that happens
// exactly where CheckDemand finds a violation.

#ifndef RICOCHET_CORE_PLAN_CHOOSE_H_
#define RICOCHET_CORE_PLAN_CHOOSE_H_

#include <array>
#include <cstddef>

#include "core/plan/demand.h"
#include "core/plan/sizes.h"
#include "ricochet/plan.h"

namespace ricochet {

struct Choice {
  Model model = Model::kUnspecified;
  double neglected = 0.0;        // What all effects left out can change together.
  double model_tolerance = 0.0;  // What the spatial model or that of finite duration is to be given; else 0.
  std::array<Decision, kEffectCount> decisions = {};
  Sizes sizes;

  bool LeavesOut(Effect effect) const {
    const Decision decision = decisions[static_cast<size_t>(effect)];
    return decision == Decision::kNegligible || decision == Decision::kExcluded;
  }
  EffectSet LeftOut() const;
  // What the plan itself leaves out can change, without what the caller excludes.
  double Negligible() const;
};

Choice ChoosePlanar(const planar::Problem& problem, const ContactPhysics& physics, const Demand& demand);
Choice ChooseSpatial(const spatial::Problem& problem, const Demand& demand);
Choice ChoosePendulum(const pendulum::Problem& problem, const ContactPhysics& physics, const Demand& demand);

// The model of ChoosePendulum for a rigid pendulum and a demand of nothing but a tolerance, at a fraction of the cost.
Model ModelOfPendulum(const pendulum::Problem& problem, double tolerance);

// Without the effects: mu = mu_s = 0 without friction, mu_s = mu without static friction.
inline void LeaveOut(EffectSet effects, double& mu, double& mu_static) {
  if (effects.Has(Effect::kFriction)) mu = mu_static = 0.0;
  if (effects.Has(Effect::kStaticFriction)) mu_static = mu;
}
// The problem may be of any model that has both coefficients.
template <typename Problem>
Problem Without(EffectSet effects, Problem problem) {
  LeaveOut(effects, problem.mu, problem.mu_static);
  return problem;
}
ContactPhysics Without(EffectSet effects, ContactPhysics physics);

// Without what the choice leaves out.
template <typename Problem>
Problem Without(const Choice& choice, const Problem& problem) {
  return Without(choice.LeftOut(), problem);
}

}  // namespace ricochet

#endif  // RICOCHET_CORE_PLAN_CHOOSE_H_
