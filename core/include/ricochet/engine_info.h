// EngineInfo: which engine computed a response.

#ifndef RICOCHET_ENGINE_INFO_H_
#define RICOCHET_ENGINE_INFO_H_

#include <string>

namespace ricochet {

struct EngineInfo {
  std::string version;      // Of the release, "major.minor.patch".
  std::string fingerprint;  // 16 hex digits over the bits of a fixed set of solves: equal fingerprints, equal numbers.
  friend bool operator==(const EngineInfo&, const EngineInfo&) = default;
};

}  // namespace ricochet

#endif  // RICOCHET_ENGINE_INFO_H_
