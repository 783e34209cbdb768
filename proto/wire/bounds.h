// Converts Bounds and Enclosure to their protos and back.

#ifndef RICOCHET_PROTO_WIRE_BOUNDS_H_
#define RICOCHET_PROTO_WIRE_BOUNDS_H_

#include "ricochet/bounds.h"
#include "ricochet/v1/bounds.pb.h"

namespace ricochet {

v1::Bounds ToProto(const Bounds& bounds);
Bounds FromProto(const v1::Bounds& proto);

v1::Enclosure ToProto(const Enclosure& enclosure);
Enclosure FromProto(const v1::Enclosure& proto);

}  // namespace ricochet

#endif  // RICOCHET_PROTO_WIRE_BOUNDS_H_
