// Converts a Plan to its proto and back. An enum number that this build does not know becomes kUnspecified.

#ifndef RICOCHET_PROTO_WIRE_PLAN_H_
#define RICOCHET_PROTO_WIRE_PLAN_H_

#include "proto/wire/enums.h"
#include "ricochet/plan.h"
#include "ricochet/v1/plan.pb.h"

namespace ricochet {

void ToProto(const Plan& plan, v1::Plan& proto);
void FromProto(const v1::Plan& proto, Plan& plan);

template <>
struct EnumPair<Effect> : SameNumbers<v1::Effect, v1::Effect_IsValid> {};

template <>
struct EnumPair<Model> : SameNumbers<v1::Model, v1::Model_IsValid> {};

template <>
struct EnumPair<Arithmetic> : SameNumbers<v1::Arithmetic, v1::Arithmetic_IsValid> {};

template <>
struct EnumPair<ArithmeticReason> : SameNumbers<v1::PlannedArithmetic::Reason, v1::PlannedArithmetic::Reason_IsValid> {
};

template <>
struct EnumPair<Decision> : SameNumbers<v1::PlannedEffect::Decision, v1::PlannedEffect::Decision_IsValid> {};

}  // namespace ricochet

#endif  // RICOCHET_PROTO_WIRE_PLAN_H_
