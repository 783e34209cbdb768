#include "proto/wire/engine.h"

namespace ricochet {

v1::Engine ToProto(const EngineInfo& engine) {
  v1::Engine proto;
  proto.set_version(engine.version);
  proto.set_fingerprint(engine.fingerprint);
  return proto;
}

EngineInfo FromProto(const v1::Engine& proto) { return {proto.version(), proto.fingerprint()}; }

}  // namespace ricochet
