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
#include "core/answer/scene_lanes.h"
#include "core/answer/spatial_lanes.h"
#include "core/sweep/checked_sweep.h"
#include "core/sweep/column.h"
#include "core/sweep/driven_scene.h"
#include "core/sweep/point_columns.h"
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
  // Numbers that are gathered from scenes.
  struct SceneColumns;

  absl::StatusOr<int64_t> SolvePoints(int64_t first, int64_t count, absl::FunctionRef<bool()> stopped,
                                      absl::FunctionRef<bool()> is_enough);
  void GoTo(int64_t index);
  bool SolveTogether(int64_t first, size_t from, size_t count, absl::FunctionRef<bool()> stopped);
  bool BeginPoint(size_t i, absl::FunctionRef<bool()> stopped);
  bool SolvePlannedPoint(size_t i, const std::optional<SceneContact>& contact, const PlannedScene& planned,
                         absl::FunctionRef<bool()> stopped);
  void SetPoint(size_t i, const Outcome& outcome);
  absl::Status SolveInLanes(int64_t first, int64_t count, SweepSummary& tallies, absl::FunctionRef<bool()> stopped);
  absl::Status SolveBlock(int64_t first, size_t from, size_t count, absl::FunctionRef<bool()> stopped);
  const SceneLanes::Columns& ColumnsOfScenes(int64_t first, size_t count);
  void FinishAlike(int64_t first, size_t from, size_t count, SweepSummary& tallies);
  void Finish(int64_t first, size_t from, size_t count, SweepSummary& tallies);
  void Add(int64_t first, size_t from, size_t end, SweepSummary& tallies) const;

  const CheckedSweep& sweep_;
  DrivenScene driven_;
  int64_t at_ = -1;  // The index of the scene that is driven now.
  const ColumnReader reader_;
  std::vector<double> numbers_;  // The columns of one point.

  // Null if the points need a scene each.
  std::unique_ptr<SceneLanes> lanes_;
  std::unique_ptr<SceneLanes::Block> block_;
  std::unique_ptr<PointColumns> point_columns_;  // If the lanes take fields,
  std::unique_ptr<SceneColumns> scene_columns_;  // else.

  SpatialLanes spatial_;                               // Points that are solved together in space,
  std::vector<std::pair<size_t, size_t>> in_spatial_;  // and their numbers in the call, with their places there.

  // The points of one call.
  std::vector<Regime> regimes_;
  std::vector<Model> models_;
  std::vector<RowStatus> statuses_;
  std::vector<double*> columns_;  // The place of the first point's value in each column,
  std::vector<double*> places_;   // and that of the current block.
};

}  // namespace ricochet

#endif  // RICOCHET_CORE_SWEEP_SWEEP_POINTS_H_
