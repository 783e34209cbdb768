// StableHash: FNV-1a over 64-bit words or bytes. Unlike absl::Hash it gives the same value in every build and process.

#ifndef RICOCHET_CORE_BASE_STABLE_HASH_H_
#define RICOCHET_CORE_BASE_STABLE_HASH_H_

#include <bit>
#include <cstdint>
#include <string_view>

namespace ricochet {

class StableHash {
 public:
  void Add(uint64_t word) {
    for (int shift = 0; shift < 64; shift += 8) AddByte((word >> shift) & 0xffU);
  }
  void Add(double value) { Add(std::bit_cast<uint64_t>(value)); }
  void Add(std::string_view bytes) {
    for (const char byte : bytes) AddByte(static_cast<unsigned char>(byte));
  }
  uint64_t value() const { return state_; }

 private:
  void AddByte(uint64_t byte) { state_ = (state_ ^ byte) * 0x100000001b3U; }

  uint64_t state_ = 0xcbf29ce484222325U;
};

}  // namespace ricochet

#endif  // RICOCHET_CORE_BASE_STABLE_HASH_H_
