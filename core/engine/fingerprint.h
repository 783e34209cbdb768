// Fingerprint: a hash over what the engine answers to a fixed set of problems, so that two engines can be compared.
//
// Scenes of every system, law and model are solved as any other scene is. Two engines with equal fingerprints give the
// same bits as far as these problems tell; sweeps are joined on that ground.

#ifndef RICOCHET_CORE_ENGINE_FINGERPRINT_H_
#define RICOCHET_CORE_ENGINE_FINGERPRINT_H_

#include <cstdint>
#include <string>
#include <vector>

#include "absl/types/span.h"

namespace ricochet {

// The answers to the problems of one kind.
struct Probe {
  std::string kind;            // "model 6" by the number of Model, "system 3" by the alternative of System, ...
  std::vector<uint64_t> bits;  // One word for each number of the answers, in a fixed order.
};

// Solves the problems, in some milliseconds.
std::vector<Probe> ProbeEngine();

// Returns 16 hex digits, which depend on every bit of the probes.
std::string FingerprintOf(absl::Span<const Probe> probes);

}  // namespace ricochet

#endif  // RICOCHET_CORE_ENGINE_FINGERPRINT_H_
