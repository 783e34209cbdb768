// SweepPoints: computes points of a sweep, any range of them, block by block.
//
// Each point goes through the model that a Solve of its scene would use, so both give the same bits, whatever the blocks.

#ifndef RICOCHET_CORE_SWEEP_SWEEP_POINTS_H_
#define RICOCHET_CORE_SWEEP_SWEEP_POINTS_H_

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "absl/functional/function_ref.h"
#include "absl/status/statusor.h"
#include "absl/types/span.h"
#include "core/answer/spatial_lanes.h"
#include "core/models/pendulum/columns.h"
#include "core/sweep/checked_sweep.h"
#include "core/sweep/driven_scene.h"
#include "ricochet/outcome.h"
#include "ricochet/sweep.h"

namespace ricochet {

// Thread safety: one thread at a time. Several objects may share a CheckedSweep.
class SweepPoints {
 public:
  // The most points of a block: those of a pendulum's SIMD lanes take well below a microsecond each.
  static constexpr int64_t kMostPoints = 1024;

  // Points in space are solved together in groups of so many, each of which takes about a microsecond.
  static constexpr int64_t kTogether = 128;

  // The sweep must outlive this object.
  explicit SweepPoints(const CheckedSweep& sweep);
  ~SweepPoints();
  SweepPoints(const SweepPoints&) = delete;
  SweepPoints& operator=(const SweepPoints&) = delete;

  // Computes points from `first` on, `count` <= kMostPoints of them unless `is_enough` ends the block after fewer.
  // `columns` has the place of the first point's value in each column; `regimes` and `statuses` have room for `count`, or
  // none if they are not wanted. The points are added to `tallies`. Returns how many they are.
  // Both functions are asked before each point, `stopped` alone before the first; SIMD lanes ask `stopped` once a
  // block, and points in space `is_enough` before each kTogether of them.
  // Errors: CANCELLED once `stopped` returns true.
  absl::StatusOr<int64_t> Compute(int64_t first, int64_t count, absl::Span<double* const> columns,
                                  absl::Span<Regime> regimes, absl::Span<RowStatus> statuses, SweepSummary& tallies,
                                  absl::FunctionRef<bool()> stopped, absl::FunctionRef<bool()> is_enough);

 private:
  absl::StatusOr<int64_t> SolvePoints(int64_t count, absl::FunctionRef<bool()> stopped,
                                      absl::FunctionRef<bool()> is_enough);
  bool SolveTogether(size_t first, size_t count, absl::FunctionRef<bool()> stopped);
  bool BeginPoint(size_t i, absl::FunctionRef<bool()> stopped);
  bool SolvePlannedPoint(size_t i, const std::optional<SceneContact>& contact, const PlannedScene& planned,
                         absl::FunctionRef<bool()> stopped);
  void SetPoint(size_t i, const Outcome& outcome);
  void SolveLanes(int64_t count);
  void GatherProblems(int64_t count);
  pendulum::Problem PlanPendulum(size_t i, pendulum::Problem problem);
  void SolveInLanes(size_t first, size_t count);
  void SolveToFirstOrder(size_t first, size_t count);
  absl::Status SolvePlanar(int64_t first, int64_t count, absl::FunctionRef<bool()> stopped);
  void SolvePlanarBlock(size_t first, size_t count);
  void FinishBlock(int64_t first, int64_t count, SweepSummary& tallies);

  const CheckedSweep& sweep_;
  DrivenScene driven_;
  int64_t at_ = -1;              // The index of the scene that is driven now.
  std::vector<double> numbers_;  // All columns of one point.

  // One block of points.
  pendulum::ProblemColumns problems_;                  // Only if the lanes give the columns.
  struct Planar;                                       // Contacts of the plane on their way through their lanes.
  std::unique_ptr<Planar> planar_;                     // Only if these lanes give the columns.
  SpatialLanes spatial_;                               // Points that are solved together in space.
  std::vector<std::pair<size_t, size_t>> in_spatial_;  // Those points, with their places there.
  std::vector<Regime> regimes_;
  std::vector<Model> models_;
  std::vector<RowStatus> statuses_;  // Until the block is finished: whether a point has numbers.
  std::unique_ptr<bool[]> inadmissible_;
  std::vector<double*> columns_;  // The place of the block's values of each column.
};

}  // namespace ricochet

#endif  // RICOCHET_CORE_SWEEP_SWEEP_POINTS_H_
