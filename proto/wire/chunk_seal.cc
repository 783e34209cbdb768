#include "proto/wire/chunk_seal.h"

#include "absl/strings/escaping.h"
#include "absl/strings/str_cat.h"
#include "core/base/stable_hash.h"
#include "proto/wire/crc32c.h"
#include "proto/wire/sweep.h"

namespace ricochet {

int64_t Crc32cOf(const v1::SweepResponse& chunk) {
  return ExtendCrc32c(ExtendCrc32c(ExtendCrc32c(0, chunk.values()), chunk.regimes()), chunk.statuses());
}

std::string GridFingerprint(const SweepRequest& request) {
  v1::SweepRequest proto = ToProto(request);
  proto.clear_first_index();
  proto.clear_end_index();
  StableHash hash;
  hash.Add(proto.SerializeAsString());  // It has no map, whose order would be open.
  return absl::StrCat(absl::Hex(hash.value(), absl::kZeroPad16));
}

void ChunkSeal::Put(v1::SweepResponse& chunk) const {
  chunk.set_crc32c(Crc32cOf(chunk));
  chunk.set_grid_fingerprint(grid_fingerprint_);
}

absl::Status ChunkSeal::Check(const v1::SweepResponse& chunk) const {
  if (chunk.grid_fingerprint() != grid_fingerprint_) {
    return absl::DataLossError(
        absl::StrCat("the sweep's chunk at point ", chunk.first_index(), " answers the request with fingerprint \"",
                     absl::CEscape(chunk.grid_fingerprint()), "\", not \"", grid_fingerprint_, "\""));
  }
  const int64_t crc = Crc32cOf(chunk);
  if (chunk.crc32c() == crc) return absl::OkStatus();
  return absl::DataLossError(absl::StrCat("the data of the sweep's chunk at point ", chunk.first_index(),
                                          " has the checksum ", crc, " instead of ", chunk.crc32c(),
                                          ": it was damaged on its way"));
}

}  // namespace ricochet
