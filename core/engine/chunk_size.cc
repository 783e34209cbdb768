#include "core/engine/chunk_size.h"

#include <algorithm>

namespace ricochet {

int64_t ChunkSize::Next(Time now) {
  if (bytes_ == 0) return bytes_ = kLeast;
  const auto took = now - emitted_at_;
  if (took < kSoon) bytes_ = std::min(2 * bytes_, kMost);
  if (took > kLate) bytes_ = std::max(bytes_ / 2, kLeast);
  return bytes_;
}

}  // namespace ricochet
