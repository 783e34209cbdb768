// ChunkSeal: what protects the chunks of one sweep on their way. It is a checksum of the data, and a fingerprint of the
// request, so that a chunk of another sweep is not taken for one of this.
//
// ricochet.v1.SweepResponse defines both fields: crc32c and grid_fingerprint.

#ifndef RICOCHET_PROTO_WIRE_CHUNK_SEAL_H_
#define RICOCHET_PROTO_WIRE_CHUNK_SEAL_H_

#include <cstdint>
#include <string>

#include "absl/status/status.h"
#include "ricochet/sweep.h"
#include "ricochet/v1/sweep.pb.h"

namespace ricochet {

// Returns the checksum of the chunk's values, regimes and statuses.
int64_t Crc32cOf(const v1::SweepResponse& chunk);

// Returns the fingerprint of the request without its range. Protobuf does not promise the same bytes in each of its
// versions, so a fingerprint is compared, not stored for years.
std::string GridFingerprint(const SweepRequest& request);

class ChunkSeal {
 public:
  explicit ChunkSeal(const SweepRequest& request) : grid_fingerprint_(GridFingerprint(request)) {}

  // Sets both fields of a chunk whose data is complete.
  void Put(v1::SweepResponse& chunk) const;

  // Errors: DATA_LOSS if the data is not that of the checksum, or if the chunk answers another request.
  absl::Status Check(const v1::SweepResponse& chunk) const;

 private:
  std::string grid_fingerprint_;
};

}  // namespace ricochet

#endif  // RICOCHET_PROTO_WIRE_CHUNK_SEAL_H_
