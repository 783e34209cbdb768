#include "proto/wire/engine.h"

#include "proto/wire/map.h"

namespace ricochet {

RICOCHET_MAP_AS(EngineInfo, v1::Engine, version, fingerprint);

RICOCHET_CONVERT_IN_PLACE(EngineInfo);
RICOCHET_CONVERT(EngineInfo);

}  // namespace ricochet
