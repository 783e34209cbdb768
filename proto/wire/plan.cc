#include "proto/wire/plan.h"

namespace ricochet {

v1::Effect ToProto(Effect value) {
  switch (value) {
    case Effect::kUnspecified:
      return v1::EFFECT_UNSPECIFIED;
    case Effect::kFriction:
      return v1::EFFECT_FRICTION;
    case Effect::kSlipStop:
      return v1::EFFECT_SLIP_STOP;
    case Effect::kSlipTurn:
      return v1::EFFECT_SLIP_TURN;
    case Effect::kStaticFriction:
      return v1::EFFECT_STATIC_FRICTION;
    case Effect::kTangentialCompliance:
      return v1::EFFECT_TANGENTIAL_COMPLIANCE;
    case Effect::kFiniteDuration:
      return v1::EFFECT_FINITE_DURATION;
    case Effect::kFiniteForces:
      return v1::EFFECT_FINITE_FORCES;
    case Effect::kHigherOrder:
      return v1::EFFECT_HIGHER_ORDER;
  }
  return v1::EFFECT_UNSPECIFIED;
}

Effect FromProto(v1::Effect proto) {
  switch (proto) {
    case v1::EFFECT_FRICTION:
      return Effect::kFriction;
    case v1::EFFECT_SLIP_STOP:
      return Effect::kSlipStop;
    case v1::EFFECT_SLIP_TURN:
      return Effect::kSlipTurn;
    case v1::EFFECT_STATIC_FRICTION:
      return Effect::kStaticFriction;
    case v1::EFFECT_TANGENTIAL_COMPLIANCE:
      return Effect::kTangentialCompliance;
    case v1::EFFECT_FINITE_DURATION:
      return Effect::kFiniteDuration;
    case v1::EFFECT_FINITE_FORCES:
      return Effect::kFiniteForces;
    case v1::EFFECT_HIGHER_ORDER:
      return Effect::kHigherOrder;
    case v1::EFFECT_UNSPECIFIED:
    case v1::Effect_INT_MIN_SENTINEL_DO_NOT_USE_:
    case v1::Effect_INT_MAX_SENTINEL_DO_NOT_USE_:
      break;
  }
  return Effect::kUnspecified;
}

v1::Model ToProto(Model value) {
  switch (value) {
    case Model::kUnspecified:
      return v1::MODEL_UNSPECIFIED;
    case Model::kNone:
      return v1::MODEL_NONE;
    case Model::kFrictionless:
      return v1::MODEL_FRICTIONLESS;
    case Model::kFirstOrder:
      return v1::MODEL_FIRST_ORDER;
    case Model::kSliding:
      return v1::MODEL_SLIDING;
    case Model::kPendulum:
      return v1::MODEL_PENDULUM;
    case Model::kPlanar:
      return v1::MODEL_PLANAR;
    case Model::kSpatial:
      return v1::MODEL_SPATIAL;
    case Model::kCompliant:
      return v1::MODEL_COMPLIANT;
    case Model::kFiniteDuration:
      return v1::MODEL_FINITE_DURATION;
    case Model::kImpactLaw:
      return v1::MODEL_IMPACT_LAW;
  }
  return v1::MODEL_UNSPECIFIED;
}

Model FromProto(v1::Model proto) {
  switch (proto) {
    case v1::MODEL_NONE:
      return Model::kNone;
    case v1::MODEL_FRICTIONLESS:
      return Model::kFrictionless;
    case v1::MODEL_FIRST_ORDER:
      return Model::kFirstOrder;
    case v1::MODEL_SLIDING:
      return Model::kSliding;
    case v1::MODEL_PENDULUM:
      return Model::kPendulum;
    case v1::MODEL_PLANAR:
      return Model::kPlanar;
    case v1::MODEL_SPATIAL:
      return Model::kSpatial;
    case v1::MODEL_COMPLIANT:
      return Model::kCompliant;
    case v1::MODEL_FINITE_DURATION:
      return Model::kFiniteDuration;
    case v1::MODEL_IMPACT_LAW:
      return Model::kImpactLaw;
    case v1::MODEL_UNSPECIFIED:
    case v1::Model_INT_MIN_SENTINEL_DO_NOT_USE_:
    case v1::Model_INT_MAX_SENTINEL_DO_NOT_USE_:
      break;
  }
  return Model::kUnspecified;
}

v1::PlannedEffect::Decision ToProto(Decision value) {
  switch (value) {
    case Decision::kUnspecified:
      return v1::PlannedEffect::DECISION_UNSPECIFIED;
    case Decision::kAbsent:
      return v1::PlannedEffect::DECISION_ABSENT;
    case Decision::kSimulated:
      return v1::PlannedEffect::DECISION_SIMULATED;
    case Decision::kNegligible:
      return v1::PlannedEffect::DECISION_NEGLIGIBLE;
    case Decision::kRequired:
      return v1::PlannedEffect::DECISION_REQUIRED;
    case Decision::kExcluded:
      return v1::PlannedEffect::DECISION_EXCLUDED;
  }
  return v1::PlannedEffect::DECISION_UNSPECIFIED;
}

Decision FromProto(v1::PlannedEffect::Decision proto) {
  switch (proto) {
    case v1::PlannedEffect::DECISION_ABSENT:
      return Decision::kAbsent;
    case v1::PlannedEffect::DECISION_SIMULATED:
      return Decision::kSimulated;
    case v1::PlannedEffect::DECISION_NEGLIGIBLE:
      return Decision::kNegligible;
    case v1::PlannedEffect::DECISION_REQUIRED:
      return Decision::kRequired;
    case v1::PlannedEffect::DECISION_EXCLUDED:
      return Decision::kExcluded;
    case v1::PlannedEffect::DECISION_UNSPECIFIED:
    case v1::PlannedEffect_Decision_PlannedEffect_Decision_INT_MIN_SENTINEL_DO_NOT_USE_:
    case v1::PlannedEffect_Decision_PlannedEffect_Decision_INT_MAX_SENTINEL_DO_NOT_USE_:
      break;
  }
  return Decision::kUnspecified;
}

static v1::PlannedEffect ToProto(const PlannedEffect& planned) {
  v1::PlannedEffect proto;
  proto.set_effect(ToProto(planned.effect));
  proto.set_decision(ToProto(planned.decision));
  proto.set_size(planned.size);
  proto.set_reason(planned.reason.Text());
  return proto;
}

static PlannedEffect FromProto(const v1::PlannedEffect& proto) {
  return {.effect = FromProto(proto.effect()),
          .decision = FromProto(proto.decision()),
          .size = proto.size(),
          .reason = Reason(proto.reason())};
}

v1::Plan ToProto(const Plan& plan) {
  v1::Plan proto;
  proto.set_model(ToProto(plan.model));
  proto.set_relative_tolerance(plan.relative_tolerance);
  proto.set_neglected(plan.neglected);
  for (const PlannedEffect& planned : plan.effects) *proto.add_effects() = ToProto(planned);
  return proto;
}

Plan FromProto(const v1::Plan& proto) {
  Plan plan{.model = FromProto(proto.model()),
            .relative_tolerance = proto.relative_tolerance(),
            .neglected = proto.neglected(),
            .effects = {}};
  for (const v1::PlannedEffect& planned : proto.effects()) plan.effects.push_back(FromProto(planned));
  return plan;
}

}  // namespace ricochet
