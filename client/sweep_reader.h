// SweepReader: the receiving end of a sweep. It reads the server's stream and checks that no point is missing.

#ifndef RICOCHET_CLIENT_SWEEP_READER_H_
#define RICOCHET_CLIENT_SWEEP_READER_H_

#include <cstdint>
#include <optional>

#include "absl/status/status.h"
#include "client/stream_reader.h"
#include "proto/wire/sweep.h"
#include "ricochet/sweep.h"
#include "ricochet/v1/sweep.pb.h"

namespace ricochet {

// Checks that chunks fit together: they come in order, without gaps, with the right sizes, up to the end of the range.
class ChunkChecker {
 public:
  explicit ChunkChecker(const SweepRequest& request);

  // Errors: DATA_LOSS if `chunk` cannot be the next one.
  absl::Status Check(const SweepChunk& chunk);
  // Errors: DATA_LOSS if chunks are missing at the end of the stream.
  absl::Status CheckEnd() const;

 private:
  int64_t columns_;
  bool with_regime_;
  int64_t next_index_;
  std::optional<int64_t> end_index_;  // Absent until the first chunk, for a grid that this build cannot read.
  bool summarised_ = false;
};

using SweepReader = StreamReader<v1::SweepResponse, SweepChunk, ChunkChecker, FromProto>;

}  // namespace ricochet

#endif  // RICOCHET_CLIENT_SWEEP_READER_H_
