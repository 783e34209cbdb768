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
// they answer the request and come from one engine, and their tallies count their points. They may come from several
// calls, each of which goes on where the last broke off.
class ChunkChecker {
 public:
  explicit ChunkChecker(const SweepRequest& request);

  // Returns the next chunk, with the points done and the tallies of all calls. Errors: DATA_LOSS if `message` cannot be
  // it; FAILED_PRECONDITION if the engine of a new call is not that of the call before.
  absl::StatusOr<SweepChunk> Accept(const v1::SweepResponse& message);

  // True once a chunk was received.
  bool has_begun() const { return engine_.has_value(); }
  // The first point that has not been received.
  int64_t next_index() const { return next_index_; }

  // Says that the next chunk is from a new call, which starts at next_index().
  void StartCall();

  // Errors: DATA_LOSS if chunks are missing at the end of the stream.
  absl::Status CheckEnd() const;

 private:
  absl::Status Check(const SweepChunk& chunk);
  absl::Status CheckSize(const SweepChunk& chunk);
  absl::Status CheckEngine(const SweepChunk& chunk);
  void JoinCalls(SweepChunk& chunk) const;

  int64_t columns_;
  bool with_regime_;
  int64_t first_index_;
  int64_t next_index_;
  std::optional<int64_t> end_index_;  // Absent until the first chunk, for a grid that this build cannot read.
  ChunkSeal seal_;
  std::optional<std::string> engine_;  // The fingerprint of the engine; absent until the first chunk.
  SweepSummary earlier_;               // The counts of the calls before this.
  TallyChecker tallies_;               // The tallies of this call.
  bool summarised_ = false;
};

// Returns the error FAILED_PRECONDITION for a sweep whose points from `index` on come from another engine than those
// before.
absl::Status OtherEngine(int64_t index, const std::string& fingerprint, const std::string& before);

}  // namespace ricochet

#endif  // RICOCHET_CLIENT_CHUNK_CHECKER_H_
