// Candidates: the models that a plan may choose, for each kind of contact from the cheapest to the most expensive.
//
// The order is that of the times that `cost` measures and that the models need in SIMD lanes; `./dev bench` compares it
// with `cost`. A plan takes the first candidate that its demand allows, so that a model which an earlier one beats
// in error, too, answers only where the earlier one leaves out more.

#ifndef RICOCHET_CORE_PLAN_CANDIDATES_H_
#define RICOCHET_CORE_PLAN_CANDIDATES_H_

#include "core/plan/effect_set.h"
#include "ricochet/plan.h"

namespace ricochet {

// The time that one impact takes, by order of magnitude on a processor of 2020.
enum class CostClass {
  kLine,      // One straight path without events: 2 ns in lanes, 30 to 100 ns alone.
  kEvents,    // A closed form whose events have to be proved: 4 to 20 ns in lanes, 25 to 400 ns alone.
  kForms,     // Formulas that have no lanes: 35 ns alone and in lanes.
  kSections,  // A path of sections, each with elementary functions or a series: 0.5 to 3 us.
  kSteps,     // An integrator's steps, some hundred: 100 to 500 us.
};

struct Candidate {
  Model model = Model::kUnspecified;
  EffectSet simulates;
  CostClass cost = CostClass::kLine;
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
    {Model::kFrictionless, {}, CostClass::kLine},
    {Model::kSliding, {Effect::kFriction}, CostClass::kLine},
    {Model::kPlanar, kPlanarEffects, CostClass::kEvents},
    {Model::kCompliant, kCompliantEffects, CostClass::kSections},
    {Model::kFiniteDuration, kDurationEffects, CostClass::kSteps},
};

// With friction, the forms of a pendulum without it and of first order are slower and less exact than the closed form.
// They serve where the caller excludes the higher orders, which the closed form has.
inline constexpr Candidate kPendulumCandidates[] = {
    {Model::kPendulum, kPlanarEffects, CostClass::kEvents},
    {Model::kFrictionless, {}, CostClass::kForms},
    {Model::kFirstOrder, {Effect::kFriction, Effect::kSlipStop}, CostClass::kForms},
    {Model::kCompliant, kCompliantEffects, CostClass::kSections},
    {Model::kFiniteDuration, kDurationEffects, CostClass::kSteps},
};

// Without friction, the form without it has half the rounding errors of the closed form.
inline constexpr Candidate kSmoothPendulumCandidates[] = {
    {Model::kFrictionless, {}, CostClass::kForms},
    {Model::kPendulum, kPlanarEffects, CostClass::kEvents},
    {Model::kCompliant, kCompliantEffects, CostClass::kSections},
    {Model::kFiniteDuration, kDurationEffects, CostClass::kSteps},
};

inline constexpr Candidate kSpatialCandidates[] = {
    {Model::kFrictionless, {}, CostClass::kLine},
    {Model::kSliding, {Effect::kFriction}, CostClass::kLine},
    {Model::kSpatial, kSpatialEffects, CostClass::kSections},
};

}  // namespace ricochet

#endif  // RICOCHET_CORE_PLAN_CANDIDATES_H_
