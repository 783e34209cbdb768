#include "proto/wire/engine.h"

#include "proto/wire/map.h"

namespace ricochet {

RICOCHET_MAP_AS(EngineInfo, v1::Engine, version, fingerprint);

void ToProto(const EngineInfo& engine, v1::Engine& proto) { Map<EngineInfo>::kFields.Write(engine, proto); }
void FromProto(const v1::Engine& proto, EngineInfo& engine) { Map<EngineInfo>::kFields.Read(proto, engine); }

v1::Engine ToProto(const EngineInfo& engine) { return Sent(engine); }
EngineInfo FromProto(const v1::Engine& proto) { return Received<EngineInfo>(proto); }

}  // namespace ricochet
