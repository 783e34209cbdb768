// SweepRun: a sweep being computed. What LocalSolver and the service share: chunk sizes, the points, the tallies.
//
//   absl::StatusOr<SweepRun> run = SweepRun::Make(request);
//   do {
//     const SweepRun::Extent extent = run->Next();
//     if (!run->Compute(extent, values, regimes, stopped)) return cancelled;
//     send(values, run->points_done(), run->done() ? run->summary() : nothing);
//   } while (!run->done());
//
// Each point goes through the model that a Solve of its scene would use, so both give the same bits. Memory does not
// depend on the number of points.

#ifndef RICOCHET_CORE_SWEEP_SWEEP_RUN_H_
#define RICOCHET_CORE_SWEEP_SWEEP_RUN_H_

#include <cstdint>
#include <memory>

#include "absl/functional/function_ref.h"
#include "absl/status/statusor.h"
#include "absl/types/span.h"
#include "ricochet/sweep.h"

namespace ricochet {

class SweepRun {
 public:
  // Points between two looks at `stopped`.
  static constexpr int64_t kPointsBetweenStops = 1024;

  // A run of consecutive points: grid index of the first, and how many.
  struct Extent {
    int64_t first_index = 0;
    int64_t count = 0;
  };

  // Errors: INVALID_ARGUMENT with every violation of the scene's undriven fields, the axes, the columns and the range.
  static absl::StatusOr<SweepRun> Make(const SweepRequest& request);

  SweepRun(SweepRun&&) noexcept;
  SweepRun& operator=(SweepRun&&) noexcept;
  ~SweepRun();

  int64_t column_count() const;
  int64_t points_total() const;  // Of the range asked for.
  int64_t points_done() const;

  bool done() const { return points_done() == points_total(); }

  // The next chunk: a small first one, then up to 512 KiB of values. Empty when all points are done.
  Extent Next() const;

  // Computes the points of `extent`, which must be Next(): column c of point i to values[c * count + i], its regime to
  // regimes[i] unless `regimes` is empty. Looks at `stopped` before every kPointsBetweenStops points, and before each
  // that has to be integrated; once it holds, returns false and the run is over.
  bool Compute(Extent extent, absl::Span<double> values, absl::Span<Regime> regimes, absl::FunctionRef<bool()> stopped);

  // Of the points done so far.
  const SweepSummary& summary() const;

 private:
  class Impl;
  explicit SweepRun(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace ricochet

#endif  // RICOCHET_CORE_SWEEP_SWEEP_RUN_H_
