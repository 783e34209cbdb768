// Bounds <-> ricochet.v1.Bounds.

#ifndef RICOCHET_PROTO_WIRE_BOUNDS_H_
#define RICOCHET_PROTO_WIRE_BOUNDS_H_

#include "core/bounds.h"
#include "ricochet/v1/bounds.pb.h"

namespace ricochet {

v1::Bounds ToProto(const Bounds& bounds);
Bounds FromProto(const v1::Bounds& proto);

}  // namespace ricochet

#endif  // RICOCHET_PROTO_WIRE_BOUNDS_H_
