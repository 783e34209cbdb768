// ThisEngine: the version and the fingerprint of this engine.

#ifndef RICOCHET_CORE_ENGINE_ENGINE_H_
#define RICOCHET_CORE_ENGINE_ENGINE_H_

#include "core/engine/engine.h"
#include "ricochet/engine_info.h"

namespace ricochet {

// The first call computes the fingerprint. Thread safety: any number of threads may call it.
const EngineInfo& ThisEngine();

}  // namespace ricochet

#endif  // RICOCHET_CORE_ENGINE_ENGINE_H_
