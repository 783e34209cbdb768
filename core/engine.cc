#include "core/engine.h"

#include <bit>
#include <cstdint>

#include "absl/strings/str_cat.h"
#include "core/models/pendulum.h"
#include "core/models/planar.h"
#include "core/models/spatial.h"

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

// 16 impacts of planar contacts and 16 in space: every law, slip that goes on, turns, reverses and stops.
planar::Problem PlanarProbe(int i) {
  return {.wtt = 2.5,
          .wtn = -1.5 + 0.2 * i,
          .wnn = 2.5,
          .u0 = i % 4 == 3 ? 0.0 : -1.0 + 0.1 * i,
          .v0 = -1.0,
          .mu = 0.1 * (i % 9),
          .mu_static = 0.1 * (i % 9),
          .law = static_cast<pendulum::Law>(i % 3),
          .coefficient = (i % 11) / 10.0};
}

spatial::Problem SpatialProbe(int i) {
  return {.w11 = 1.96,
          .w12 = 0.24,
          .w13 = 0.6,
          .w22 = 2.96,
          .w23 = -0.8,
          .w33 = 1.85,
          .u0 = {1.0 - 0.2 * i, 0.6},
          .v0 = -1.0,
          .mu = 0.1 * (i % 10),
          .mu_static = 0.1 * (i % 10),
          .law = static_cast<pendulum::Law>(i % 3),
          .coefficient = (i % 11) / 10.0};
}

template <typename Impact>
void Add(const Impact& impact, StableHash& hash) {
  hash.Add(static_cast<uint64_t>(impact.regime));
  for (const double value : {impact.v1, impact.tau_compression, impact.tau1, impact.work_normal_compression,
                             impact.work_normal_restitution, impact.energy_change}) {
    hash.Add(std::bit_cast<uint64_t>(value));
  }
}

std::string Fingerprint() {
  StableHash hash;
  for (int i = 0; i < 16; ++i) {
    Add(planar::Solve(PlanarProbe(i)), hash);
    Add(spatial::Solve(SpatialProbe(i)), hash);
  }
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
