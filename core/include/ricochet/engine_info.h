// EngineInfo: which engine computed a response; ThisEngine: the one that is linked into this program.

#ifndef RICOCHET_ENGINE_INFO_H_
#define RICOCHET_ENGINE_INFO_H_

#include <string>

namespace ricochet {

struct EngineInfo {
  std::string version;      // Version of the release, "major.minor.patch".
  std::string fingerprint;  // 16 hex digits that hash a fixed set of answers: equal fingerprints mean equal bits.
  friend bool operator==(const EngineInfo&, const EngineInfo&) = default;
};

// The version of this library, which takes no time to know.
const char* ThisVersion();

// The first call computes the fingerprint: it solves some hundred impacts and makes two fits, which takes some tens of
// milliseconds. Thread safety: any number of threads may call it.
const EngineInfo& ThisEngine();

}  // namespace ricochet

#endif  // RICOCHET_ENGINE_INFO_H_
