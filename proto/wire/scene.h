// Converts a Scene to its proto and back. Every value converts: a part that a request left unset stays unset, and
// Validate reports it.

#ifndef RICOCHET_PROTO_WIRE_SCENE_H_
#define RICOCHET_PROTO_WIRE_SCENE_H_

#include "ricochet/scene.h"
#include "ricochet/v1/scene.pb.h"

namespace ricochet {

v1::Scene ToProto(const Scene& scene);
Scene FromProto(const v1::Scene& proto);
void ToProto(const Scene& scene, v1::Scene& proto);
void FromProto(const v1::Scene& proto, Scene& scene);
void ToProto(const Mechanism& mechanism, v1::Mechanism& proto);
void FromProto(const v1::Mechanism& proto, Mechanism& mechanism);

}  // namespace ricochet

#endif  // RICOCHET_PROTO_WIRE_SCENE_H_
