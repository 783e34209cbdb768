#include "core/study/cost_families.h"

#include "core/plan/effect_set.h"

namespace ricochet {
namespace {

EffectSet SimulatedBy(Model model) {
  constexpr EffectSet kRigid = {Effect::kFriction, Effect::kSlipStop, Effect::kSlipTurn, Effect::kStaticFriction,
                                Effect::kHigherOrder};
  switch (model) {
    case Model::kSliding:
      return {Effect::kFriction};
    case Model::kFirstOrder:
      return {Effect::kFriction, Effect::kSlipStop};
    case Model::kPendulum:
    case Model::kPlanar:
    case Model::kSpatial:
      return kRigid;
    case Model::kCompliant:
      return kRigid | EffectSet{Effect::kTangentialCompliance};
    case Model::kFiniteDuration:
      return kRigid | EffectSet{Effect::kTangentialCompliance, Effect::kFiniteDuration, Effect::kFiniteForces};
    case Model::kFrictionless:
    case Model::kImpactLaw:
    case Model::kNone:
    case Model::kUnspecified:
      break;
  }
  return {};
}

}  // namespace

Demand DemandFor(Model model) {
  // The frictionless form has rounding errors, so that it is never within a tolerance of 0; with friction excluded there
  // is no cheaper one.
  const EffectSet simulated = SimulatedBy(model);
  Demand demand = {.relative_tolerance = model == Model::kFrictionless ? 0.1 : 0.0};
  for (const Effect effect : kEffects) {
    if (!simulated.Has(effect)) demand.excluded.Add(effect);
  }
  return demand;
}

std::string NameOf(Arithmetic arithmetic) {
  switch (arithmetic) {
    case Arithmetic::kPlain:
      return "plain";
    case Arithmetic::kCompensated:
      return "compensated";
    case Arithmetic::kCertified:
      return "certified";
    case Arithmetic::kUnspecified:
      break;
  }
  return "";
}

}  // namespace ricochet
