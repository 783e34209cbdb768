// ChunkChecker: checks that the chunks of a sweep are whole and fit together.

#ifndef RICOCHET_CLIENT_CHUNK_CHECKER_H_
#define RICOCHET_CLIENT_CHUNK_CHECKER_H_

#include <cstdint>
#include <optional>
#include <string>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "client/tally_checker.h"
#include "proto/wire/chunk_seal.h"
#include "ricochet/sweep.h"
#include "ricochet/v1/sweep.pb.h"

namespace ricochet {

// The chunks come in order, without gaps, with the right sizes, up to the end of the range. Their checksums are right,
// they answer the request and come from one engine, and their tallies count their points.
class ChunkChecker {
 public:
  explicit ChunkChecker(const SweepRequest& request);

  // Returns the next chunk. Errors: DATA_LOSS if `message` cannot be it.
  absl::StatusOr<SweepChunk> Take(const v1::SweepResponse& message);

  // Errors: DATA_LOSS if chunks are missing at the end of the stream.
  absl::Status CheckEnd() const;

 private:
  absl::Status Check(const SweepChunk& chunk);
  absl::Status CheckSize(const SweepChunk& chunk);

  int64_t columns_;
  bool with_regime_;
  int64_t next_index_;
  std::optional<int64_t> end_index_;  // Absent until the first chunk, for a grid that this build cannot read.
  ChunkSeal seal_;
  std::optional<std::string> engine_;  // The fingerprint of the engine; absent until the first chunk.
  TallyChecker tallies_;
  bool summarised_ = false;
};

}  // namespace ricochet

#endif  // RICOCHET_CLIENT_CHUNK_CHECKER_H_
