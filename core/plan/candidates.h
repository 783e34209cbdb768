// Candidates: the models that a plan may choose, for each kind of contact from the cheapest to the most expensive.
//
// The order is that of the times that `cost` measures and that the models need in SIMD lanes; `./dev bench` compares it
// with `cost`. A plan takes the first candidate that its demand allows. A model that is slower and less exact than an
// earlier one therefore answers only where the earlier one leaves out more.

#ifndef RICOCHET_CORE_PLAN_CANDIDATES_H_
#define RICOCHET_CORE_PLAN_CANDIDATES_H_

#include "core/plan/effect_set.h"
#include "ricochet/plan.h"

namespace ricochet {

struct Candidate {
  Model model = Model::kUnspecified;
  EffectSet simulates;
};

inline constexpr EffectSet kPlanarEffects = {Effect::kFriction, Effect::kSlipStop, Effect::kStaticFriction,
                                             Effect::kHigherOrder};
inline constexpr EffectSet kSpatialEffects = {Effect::kFriction, Effect::kSlipStop, Effect::kSlipTurn,
                                              Effect::kStaticFriction};
inline constexpr EffectSet kCompliantEffects = kPlanarEffects | EffectSet{Effect::kTangentialCompliance};
inline constexpr EffectSet kDurationEffects =
    kCompliantEffects | EffectSet{Effect::kFiniteDuration, Effect::kFiniteForces};

// Alone, the sliding model takes as long as the planar one; in lanes it takes a seventh of its time.
inline constexpr Candidate kPlanarCandidates[] = {
    {Model::kFrictionless, {}},
    {Model::kSliding, {Effect::kFriction}},
    {Model::kPlanar, kPlanarEffects},
    {Model::kCompliant, kCompliantEffects},
    {Model::kFiniteDuration, kDurationEffects},
};

// With friction, a pendulum's frictionless and first-order forms are slower and less exact than the closed form. They
// serve only if the caller excludes the higher orders, which the closed form contains.
inline constexpr Candidate kPendulumCandidates[] = {
    {Model::kPendulum, kPlanarEffects},
    {Model::kFrictionless, {}},
    {Model::kFirstOrder, {Effect::kFriction, Effect::kSlipStop}},
    {Model::kCompliant, kCompliantEffects},
    {Model::kFiniteDuration, kDurationEffects},
};

// Without friction, the frictionless form has half the rounding errors of the closed form.
inline constexpr Candidate kSmoothPendulumCandidates[] = {
    {Model::kFrictionless, {}},
    {Model::kPendulum, kPlanarEffects},
    {Model::kCompliant, kCompliantEffects},
    {Model::kFiniteDuration, kDurationEffects},
};

inline constexpr Candidate kSpatialCandidates[] = {
    {Model::kFrictionless, {}},
    {Model::kSliding, {Effect::kFriction}},
    {Model::kSpatial, kSpatialEffects},
};

}  // namespace ricochet

#endif  // RICOCHET_CORE_PLAN_CANDIDATES_H_
