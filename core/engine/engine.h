// This engine's version and fingerprint.

#ifndef RICOCHET_CORE_ENGINE_ENGINE_H_
#define RICOCHET_CORE_ENGINE_ENGINE_H_

#include "core/engine/engine.h"
#include "ricochet/engine_info.h"

namespace ricochet {

// Computed at the first call, thread-safe.
const EngineInfo& ThisEngine();

}  // namespace ricochet

#endif  // RICOCHET_CORE_ENGINE_ENGINE_H_
