// Converts Plan and DemandFields to proto and back.

#ifndef RICOCHET_PROTO_WIRE_PLAN_H_
#define RICOCHET_PROTO_WIRE_PLAN_H_

#include "core/plan/demand_fields.h"
#include "ricochet/plan.h"
#include "ricochet/v1/plan.pb.h"

namespace ricochet {

v1::Effect ToProto(Effect value);
// A number that this build does not know becomes kUnspecified, here and below.
Effect FromProto(v1::Effect proto);

v1::Model ToProto(Model value);
Model FromProto(v1::Model proto);

v1::Arithmetic ToProto(Arithmetic value);
Arithmetic FromProto(v1::Arithmetic proto);
v1::PlannedArithmetic::Reason ToProto(ArithmeticReason value);
ArithmeticReason FromProto(v1::PlannedArithmetic::Reason proto);

v1::PlannedEffect::Decision ToProto(Decision value);
Decision FromProto(v1::PlannedEffect::Decision proto);

v1::Plan ToProto(const Plan& plan);
Plan FromProto(const v1::Plan& proto);

// A request has the fields of a demand among its own.
template <typename Request>
void SetDemand(const DemandFields& demand, Request& proto) {
  if (demand.relative_tolerance.has_value()) proto.set_relative_tolerance(*demand.relative_tolerance);
  for (const Effect effect : demand.required) proto.add_required(ToProto(effect));
  for (const Effect effect : demand.excluded) proto.add_excluded(ToProto(effect));
}

template <typename Request>
DemandFields DemandOf(const Request& proto) {
  DemandFields demand;
  if (proto.has_relative_tolerance()) demand.relative_tolerance = proto.relative_tolerance();
  for (const int number : proto.required()) demand.required.push_back(FromProto(static_cast<v1::Effect>(number)));
  for (const int number : proto.excluded()) demand.excluded.push_back(FromProto(static_cast<v1::Effect>(number)));
  return demand;
}

}  // namespace ricochet

#endif  // RICOCHET_PROTO_WIRE_PLAN_H_
