// Converts the requests and parts of a study of cost to their protos and back.

#ifndef RICOCHET_PROTO_WIRE_COST_H_
#define RICOCHET_PROTO_WIRE_COST_H_

#include "proto/wire/enums.h"
#include "ricochet/cost.h"
#include "ricochet/v1/cost.pb.h"

namespace ricochet {

v1::CostRequest ToProto(const CostRequest& request);
CostRequest FromProto(const v1::CostRequest& proto);

// A number that this build does not know becomes kUnspecified.
template <>
struct EnumPair<CostStatus> : SameNumbers<v1::CostRow::Status, v1::CostRow::Status_IsValid> {};

v1::CostResponse ToProto(const CostChunk& chunk);
CostChunk FromProto(const v1::CostResponse& proto);

}  // namespace ricochet

#endif  // RICOCHET_PROTO_WIRE_COST_H_
