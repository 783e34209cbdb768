// Converts InfoRequest and InfoResponse to their protos and back.

#ifndef RICOCHET_PROTO_WIRE_INFO_H_
#define RICOCHET_PROTO_WIRE_INFO_H_

#include "ricochet/info.h"
#include "ricochet/v1/info.pb.h"

namespace ricochet {

v1::InfoRequest ToProto(const InfoRequest& request);
InfoRequest FromProto(const v1::InfoRequest& proto);

v1::InfoResponse ToProto(const InfoResponse& response);
InfoResponse FromProto(const v1::InfoResponse& proto);

}  // namespace ricochet

#endif  // RICOCHET_PROTO_WIRE_INFO_H_
