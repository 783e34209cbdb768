// ChunkSize: how large the chunks of a sweep are, by how soon its reader comes for the next one.
//
// A reader that is slow or stops holds one chunk in memory, in the buffers of whoever passes it on, for as long as it
// takes. So the chunks start small, double while the reader comes back at once, and halve while it takes long. A reader
// that keeps up gets large chunks after a few small ones.

#ifndef RICOCHET_CORE_ENGINE_CHUNK_SIZE_H_
#define RICOCHET_CORE_ENGINE_CHUNK_SIZE_H_

#include <algorithm>
#include <chrono>
#include <cstdint>

namespace ricochet {

class ChunkSize {
 public:
  using Time = std::chrono::steady_clock::time_point;

  // A reader that comes back sooner gets a chunk twice as large, up to kMost.
  static constexpr std::chrono::milliseconds kSoon{100};
  // A reader that comes back later gets a chunk half as large, down to kLeast.
  static constexpr std::chrono::milliseconds kLate{400};
  static constexpr int64_t kLeast = int64_t{16} << 10;
  static constexpr int64_t kMost = int64_t{512} << 10;

  // Returns the most bytes of values of the chunk that the reader asks for at `now`.
  int64_t Next(Time now) {
    if (bytes_ == 0) return bytes_ = kLeast;
    const auto took = now - emitted_at_;
    if (took < kSoon) bytes_ = std::min(2 * bytes_, kMost);
    if (took > kLate) bytes_ = std::max(bytes_ / 2, kLeast);
    return bytes_;
  }

  // Says that the reader got that chunk at `now`.
  void Emitted(Time now) { emitted_at_ = now; }

 private:
  int64_t bytes_ = 0;  // Size of the last chunk; 0 before the first.
  Time emitted_at_;
};

}  // namespace ricochet

#endif  // RICOCHET_CORE_ENGINE_CHUNK_SIZE_H_
