// Scene <-> ricochet.v1.Scene. Both ways are total: what a request left open stays open, for Validate to report.

#ifndef RICOCHET_PROTO_WIRE_SCENE_H_
#define RICOCHET_PROTO_WIRE_SCENE_H_

#include "ricochet/scene.h"
#include "ricochet/v1/scene.pb.h"

namespace ricochet {

v1::Scene ToProto(const Scene& scene);
Scene FromProto(const v1::Scene& proto);

}  // namespace ricochet

#endif  // RICOCHET_PROTO_WIRE_SCENE_H_
