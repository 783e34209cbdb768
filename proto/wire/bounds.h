// Converts Bounds and Enclosure to their protos and back.

#ifndef RICOCHET_PROTO_WIRE_BOUNDS_H_
#define RICOCHET_PROTO_WIRE_BOUNDS_H_

#include "ricochet/bounds.h"
#include "ricochet/v1/bounds.pb.h"

namespace ricochet {

void ToProto(const Bounds& bounds, v1::Bounds& proto);
void FromProto(const v1::Bounds& proto, Bounds& bounds);

void ToProto(const Enclosure& enclosure, v1::Enclosure& proto);
void FromProto(const v1::Enclosure& proto, Enclosure& enclosure);

}  // namespace ricochet

#endif  // RICOCHET_PROTO_WIRE_BOUNDS_H_
