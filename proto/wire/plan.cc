#include "proto/wire/plan.h"

#include <utility>
#include <vector>

#include "proto/wire/enums.h"

namespace ricochet {

v1::Effect ToProto(Effect value) { return SameNumber<v1::Effect>(value, v1::Effect_IsValid); }

Effect FromProto(v1::Effect proto) { return SameNumber<Effect>(proto, v1::Effect_IsValid); }

v1::Model ToProto(Model value) { return SameNumber<v1::Model>(value, v1::Model_IsValid); }

Model FromProto(v1::Model proto) { return SameNumber<Model>(proto, v1::Model_IsValid); }

v1::Arithmetic ToProto(Arithmetic value) { return SameNumber<v1::Arithmetic>(value, v1::Arithmetic_IsValid); }

v1::PlannedArithmetic::Reason ToProto(ArithmeticReason value) {
  return SameNumber<v1::PlannedArithmetic::Reason>(value, v1::PlannedArithmetic::Reason_IsValid);
}

ArithmeticReason FromProto(v1::PlannedArithmetic::Reason proto) {
  return SameNumber<ArithmeticReason>(proto, v1::PlannedArithmetic::Reason_IsValid);
}

Arithmetic FromProto(v1::Arithmetic proto) { return SameNumber<Arithmetic>(proto, v1::Arithmetic_IsValid); }

v1::PlannedEffect::Decision ToProto(Decision value) {
  return SameNumber<v1::PlannedEffect::Decision>(value, v1::PlannedEffect::Decision_IsValid);
}

Decision FromProto(v1::PlannedEffect::Decision proto) {
  return SameNumber<Decision>(proto, v1::PlannedEffect::Decision_IsValid);
}

static v1::PlannedEffect ToProto(const PlannedEffect& planned) {
  v1::PlannedEffect proto;
  proto.set_effect(ToProto(planned.effect));
  proto.set_decision(ToProto(planned.decision));
  proto.set_size(planned.size);
  proto.set_reason(planned.reason);
  return proto;
}

static PlannedEffect FromProto(const v1::PlannedEffect& proto) {
  return {.effect = FromProto(proto.effect()),
          .decision = FromProto(proto.decision()),
          .size = proto.size(),
          .reason = proto.reason()};
}

static v1::PlannedArithmetic ToProto(const PlannedArithmetic& arithmetic) {
  v1::PlannedArithmetic proto;
  proto.set_arithmetic(ToProto(arithmetic.arithmetic));
  proto.set_reason(ToProto(arithmetic.reason));
  if (arithmetic.rounding_error.has_value()) proto.set_rounding_error(*arithmetic.rounding_error);
  return proto;
}

static PlannedArithmetic FromProto(const v1::PlannedArithmetic& proto) {
  PlannedArithmetic arithmetic = {.arithmetic = FromProto(proto.arithmetic()), .reason = FromProto(proto.reason())};
  if (proto.has_rounding_error()) arithmetic.rounding_error = proto.rounding_error();
  return arithmetic;
}

v1::Plan ToProto(const Plan& plan) {
  v1::Plan proto;
  proto.set_model(ToProto(plan.model));
  proto.set_relative_tolerance(plan.relative_tolerance);
  proto.set_neglected(plan.neglected);
  for (const PlannedEffect& planned : plan.effects.List()) *proto.add_effects() = ToProto(planned);
  *proto.mutable_arithmetic() = ToProto(plan.arithmetic);
  return proto;
}

Plan FromProto(const v1::Plan& proto) {
  Plan plan{.model = FromProto(proto.model()),
            .relative_tolerance = proto.relative_tolerance(),
            .neglected = proto.neglected()};
  std::vector<PlannedEffect> effects;
  for (const v1::PlannedEffect& planned : proto.effects()) effects.push_back(FromProto(planned));
  plan.effects = PlannedEffects(std::move(effects));
  plan.arithmetic = FromProto(proto.arithmetic());
  return plan;
}

}  // namespace ricochet
