// SweepRun: a sweep computed chunk by chunk: its points, their tallies and the size of each chunk.
//
//   absl::StatusOr<SweepRun> run = SweepRun::Make(request);
//   while (!run->ended()) {
//     absl::StatusOr<SweepChunk> chunk = run->NextChunk(stopped);
//     if (!chunk.ok()) return chunk.status();
//     Send(*chunk);
//   }
//
// Each point goes through the model that a Solve of its scene would use, so both give the same bits, whatever the range
// asked for and the sizes of the chunks. Memory does not depend on the number of points.

#ifndef RICOCHET_CORE_SWEEP_SWEEP_RUN_H_
#define RICOCHET_CORE_SWEEP_SWEEP_RUN_H_

#include <cstdint>
#include <memory>

#include "absl/functional/function_ref.h"
#include "absl/status/statusor.h"
#include "ricochet/sweep.h"

namespace ricochet {

class SweepRun {
 public:
  // The most points between two looks at `stopped`: those of a pendulum's SIMD lanes take well below a microsecond each.
  static constexpr int64_t kPointsBetweenStops = 1024;
  // The most bytes of values in a chunk, unless one point has more.
  static constexpr int64_t kChunkBytes = int64_t{512} << 10;

  // Errors: INVALID_ARGUMENT with every violation of the scene's undriven fields, the axes, the columns and the range.
  static absl::StatusOr<SweepRun> Make(const SweepRequest& request);

  SweepRun(SweepRun&&) noexcept;
  SweepRun& operator=(SweepRun&&) noexcept;
  ~SweepRun();

  int64_t points_total() const;  // Points of the range asked for.
  int64_t points_done() const;   // Points computed so far; after a stop these may be more than the chunks have.
  bool ended() const;            // True once the last chunk has been made.

  // Computes the next chunk: a small first one, then up to `most_bytes` of values each, in [1, kChunkBytes], but at least
  // one point. It ends early, but not before its first point, once `is_enough` says that it took long enough; no point
  // depends on that. The last chunk has the summary; a range without points has that one chunk. The engine is left to
  // the caller. Not to be called once the run has ended. Both functions are asked before every kPointsBetweenStops points
  // of SIMD lanes, and before each other point.
  // Errors: CANCELLED once `stopped` returns true; the run must not be used any more.
  absl::StatusOr<SweepChunk> NextChunk(absl::FunctionRef<bool()> stopped, absl::FunctionRef<bool()> is_enough,
                                       int64_t most_bytes = kChunkBytes);

  // Computes a chunk that takes as long as it takes.
  absl::StatusOr<SweepChunk> NextChunk(absl::FunctionRef<bool()> stopped) {
    return NextChunk(stopped, [] { return false; });
  }

 private:
  class Impl;
  explicit SweepRun(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace ricochet

#endif  // RICOCHET_CORE_SWEEP_SWEEP_RUN_H_
