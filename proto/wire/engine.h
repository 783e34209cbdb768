// Converts EngineInfo to its proto and back.

#ifndef RICOCHET_PROTO_WIRE_ENGINE_H_
#define RICOCHET_PROTO_WIRE_ENGINE_H_

#include "ricochet/engine_info.h"
#include "ricochet/v1/engine.pb.h"

namespace ricochet {

v1::Engine ToProto(const EngineInfo& engine);
EngineInfo FromProto(const v1::Engine& proto);
void ToProto(const EngineInfo& engine, v1::Engine& proto);
void FromProto(const v1::Engine& proto, EngineInfo& engine);

}  // namespace ricochet

#endif  // RICOCHET_PROTO_WIRE_ENGINE_H_
