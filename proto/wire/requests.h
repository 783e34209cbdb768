// Converts the requests and responses of Solve, Plan and Bounds to their protos and back.

#ifndef RICOCHET_PROTO_WIRE_REQUESTS_H_
#define RICOCHET_PROTO_WIRE_REQUESTS_H_

#include "ricochet/solver.h"
#include "ricochet/v1/impact_service.pb.h"

namespace ricochet {

v1::SolveRequest ToProto(const SolveRequest& request);
SolveRequest FromProto(const v1::SolveRequest& proto);
v1::SolveResponse ToProto(const SolveResponse& response);
SolveResponse FromProto(const v1::SolveResponse& proto);

v1::PlanRequest ToProto(const PlanRequest& request);
PlanRequest FromProto(const v1::PlanRequest& proto);
v1::PlanResponse ToProto(const PlanResponse& response);
PlanResponse FromProto(const v1::PlanResponse& proto);

v1::BoundsRequest ToProto(const BoundsRequest& request);
BoundsRequest FromProto(const v1::BoundsRequest& proto);
v1::BoundsResponse ToProto(const BoundsResponse& response);
BoundsResponse FromProto(const v1::BoundsResponse& proto);

}  // namespace ricochet

#endif  // RICOCHET_PROTO_WIRE_REQUESTS_H_
