// SweepRun: a sweep computed chunk by chunk, by the thread that asks for the chunks and by others that help.
//
// All threads fill the same buffers, of one chunk each, with blocks of points that take a millisecond at most where a
// point takes less. The first buffer becomes the next chunk once it is full. Between two chunks helpers fill one buffer
// and then stop, so that a caller who is slow holds little. Neither the range asked for nor the chunks or threads
// change the bits of a point. Memory does not depend on the number of points.

#ifndef RICOCHET_CORE_ENGINE_SWEEP_RUN_H_
#define RICOCHET_CORE_ENGINE_SWEEP_RUN_H_

#include <cstdint>
#include <memory>

#include "absl/functional/function_ref.h"
#include "absl/status/statusor.h"
#include "core/rows/row_solver.h"
#include "ricochet/helpers.h"
#include "ricochet/sweep.h"

namespace ricochet {

// Thread safety: one thread at a time. Destroying a run waits until nobody helps it any more, which takes as long as
// one block does, or a step of an expensive point.
class SweepRun {
 public:
  // The most bytes of values in a chunk, unless one point has more.
  static constexpr int64_t kChunkBytes = int64_t{512} << 10;
  // The most points in SIMD lanes between two looks at `stopped`.
  static constexpr int64_t kPointsBetweenStops = RowSolver::kRowsBetweenStops;

  // Helpers are asked once a run has lasted for a millisecond; null stands for none.
  // Errors: those of CheckSweep.
  static absl::StatusOr<SweepRun> Make(const SweepRequest& request, std::shared_ptr<Helpers> helpers = nullptr);

  SweepRun(SweepRun&&) noexcept;
  SweepRun& operator=(SweepRun&&) noexcept;
  ~SweepRun();

  int64_t points_total() const;  // Points of the range asked for.
  int64_t points_done() const;   // Points computed so far; these may be more than the chunks have.
  bool ended() const;            // True once the last chunk has been made.

  // Gives the next chunk: a small first one, then up to `most_bytes` of values each, in [1, kChunkBytes], but at least
  // one point. It ends early, but not before its first point, once `is_enough` says that it took long enough; no point
  // depends on that. The last chunk has the summary; a range without points has that one chunk. The engine is left to
  // the caller. Not to be called once the run has ended. Both functions are asked on this thread alone: once a chunk at
  // least, as RowSolver::Solve says for the points that it computes, and every millisecond in which it waits for
  // helpers. Errors: CANCELLED once `stopped` returns true; the run must not be used any more. An exception that a
  // helper meets is thrown here.
  absl::StatusOr<SweepChunk> NextChunk(absl::FunctionRef<bool()> stopped, absl::FunctionRef<bool()> is_enough,
                                       int64_t most_bytes = kChunkBytes);

  // Computes the next chunk without a limit on its time.
  absl::StatusOr<SweepChunk> NextChunk(absl::FunctionRef<bool()> stopped) {
    return NextChunk(stopped, [] { return false; });
  }

 private:
  class Impl;
  explicit SweepRun(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace ricochet

#endif  // RICOCHET_CORE_ENGINE_SWEEP_RUN_H_
