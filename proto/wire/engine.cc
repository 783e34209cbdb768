#include "proto/wire/engine.h"

#include "proto/wire/map.h"

namespace ricochet {

template <>
struct Map<EngineInfo> : Between<EngineInfo, v1::Engine> {
  using Fields = Entries<Entry(&T::version, &P::version, &P::mutable_version),
                         Entry(&T::fingerprint, &P::fingerprint, &P::mutable_fingerprint)>;
};

void ToProto(const EngineInfo& engine, v1::Engine& proto) { Map<EngineInfo>::Fields::Write(engine, proto); }
void FromProto(const v1::Engine& proto, EngineInfo& engine) { Map<EngineInfo>::Fields::Read(proto, engine); }

v1::Engine ToProto(const EngineInfo& engine) { return Sent(engine); }
EngineInfo FromProto(const v1::Engine& proto) { return Received<EngineInfo>(proto); }

}  // namespace ricochet
