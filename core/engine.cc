#include "core/engine.h"

#include <bit>
#include <cstdint>

#include "absl/strings/str_cat.h"
#include "core/models/pendulum.h"

namespace ricochet {
namespace {

// FNV-1a over 64-bit words: a hash that is the same in every build and process, which absl::Hash is not.
class StableHash {
 public:
  void Add(uint64_t word) {
    for (int shift = 0; shift < 64; shift += 8) {
      state_ = (state_ ^ ((word >> shift) & 0xffU)) * 0x100000001b3U;
    }
  }
  uint64_t value() const { return state_; }

 private:
  uint64_t state_ = 0xcbf29ce484222325U;
};

// 64 impacts that between them reach every law and regime.
pendulum::Problem Probe(int i) {
  const int step = i / 8;  // 0 ... 7
  return {.inertia = 1.0 + 0.1 * i,
          .a = 0.3 + 0.07 * step,
          .b = i % 5 == 0 ? 0.0 : 1.0 - 0.25 * step,
          .omega_minus = i == 63 ? 1.0 : -1.0 - 0.01 * i,
          .mu = 0.05 * (i % 8),
          .mu_static = 0.05 * (i % 8) + (i % 7 == 0 ? 0.2 : 0.0),
          .law = static_cast<pendulum::Law>(i % 3),
          .coefficient = (i % 11) / 10.0};
}

std::string Fingerprint() {
  StableHash hash;
  for (int i = 0; i < 64; ++i) {
    const pendulum::Impact impact = pendulum::Solve(Probe(i));
    hash.Add(static_cast<uint64_t>(impact.regime));
    for (const double value : impact.values) hash.Add(std::bit_cast<uint64_t>(value));
  }
  return absl::StrCat(absl::Hex(hash.value(), absl::kZeroPad16));
}

}  // namespace

const EngineInfo& ThisEngine() {
  static const EngineInfo engine = {.version = RICOCHET_VERSION, .fingerprint = Fingerprint()};
  return engine;
}

}  // namespace ricochet
