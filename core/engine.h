// Which engine computed a response.

#ifndef RICOCHET_CORE_ENGINE_H_
#define RICOCHET_CORE_ENGINE_H_

#include <string>

namespace ricochet {

struct EngineInfo {
  std::string version;      // Of the release, "major.minor.patch".
  std::string fingerprint;  // 16 hex digits over the bits of a fixed set of solves: equal fingerprints, equal numbers.
  friend bool operator==(const EngineInfo&, const EngineInfo&) = default;
};

// This engine. Computed at the first call, thread-safe.
const EngineInfo& ThisEngine();

}  // namespace ricochet

#endif  // RICOCHET_CORE_ENGINE_H_
