// Converts EngineInfo to its proto and back.

#ifndef RICOCHET_PROTO_WIRE_ENGINE_H_
#define RICOCHET_PROTO_WIRE_ENGINE_H_

#include "core/engine/engine.h"
#include "ricochet/v1/engine.pb.h"

namespace ricochet {

v1::Engine ToProto(const EngineInfo& engine);
EngineInfo FromProto(const v1::Engine& proto);

}  // namespace ricochet

#endif  // RICOCHET_PROTO_WIRE_ENGINE_H_
