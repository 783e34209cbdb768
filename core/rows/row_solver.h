// RowSolver: solves rows of a source, any range of them, block by block.
//
// Rows that SIMD lanes take (core/rows/scene_lanes.h) go through them, every other one goes by its scene, and impacts
// in space are solved together. Each row goes through the model that a Solve of its scene would use, so all ways give
// the same bits, whatever the blocks.

#ifndef RICOCHET_CORE_ROWS_ROW_SOLVER_H_
#define RICOCHET_CORE_ROWS_ROW_SOLVER_H_

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "absl/functional/function_ref.h"
#include "absl/types/span.h"
#include "core/plan/demand.h"
#include "core/plan/planned_scene.h"
#include "core/rows/column.h"
#include "core/rows/derivative_columns.h"
#include "core/rows/driven_scene.h"
#include "core/rows/lane_columns.h"
#include "core/rows/row_source.h"
#include "core/rows/scene_lanes.h"
#include "core/rows/spatial_lanes.h"
#include "ricochet/batch.h"
#include "ricochet/outcome.h"
#include "ricochet/scene.h"
#include "ricochet/sweep.h"

namespace ricochet {

// Says where the results of rows go.
struct RowSink {
  std::vector<double*> columns;             // The place of the first row's value in each column.
  absl::Span<Regime> regimes;               // Empty, or receives the regime of each row.
  absl::Span<RowStatus> statuses;           // Empty, or receives the status of each row.
  SweepSummary& counts;                     // The rows are added to it.
  std::vector<BadRow>* bad_rows = nullptr;  // Null, or receives the rows without numbers until it has kMostBadRows.
};

// Thread safety: one thread at a time.
class RowSolver {
 public:
  static constexpr size_t kBlock = RowSource::kBlock;
  // The most rows between two questions while they go in SIMD lanes, which take well below a microsecond for each.
  static constexpr int64_t kRowsBetweenStops = 1024;

  // The rows are those of a request that has been checked (core/rows/checked_rows.h): scenes that differ from `scene`
  // in the values of their fields.
  RowSolver(const Scene& scene, std::vector<std::string> fields, std::vector<std::string> columns,
            const Demand& demand);
  RowSolver(const RowSolver&) = delete;
  RowSolver& operator=(const RowSolver&) = delete;

  // True if SIMD lanes give all columns, so that a row takes well below a microsecond.
  bool is_in_lanes() const { return lanes_ != nullptr && derivatives_.empty(); }
  // True if the rows are impacts in space, of which a few are solved together.
  bool is_in_space() const { return in_space_; }

  // Solves the rows [first, first + count), or fewer if `is_enough` says so, and returns how many they are; or nothing
  // once `stopped` returns true. Both functions are asked before each kRowsBetweenStops rows in SIMD lanes and before
  // each row that goes by its scene, but `is_enough` once a block for systems in space, and not before the first row.
  std::optional<int64_t> Solve(RowSource& source, int64_t first, int64_t count, const RowSink& sink,
                               absl::FunctionRef<bool()> stopped, absl::FunctionRef<bool()> is_enough);

 private:
  // The functions below work on rows of the current block.
  std::optional<size_t> SolveInLanes(size_t count, absl::FunctionRef<bool()> stopped);
  std::optional<size_t> SolveScenes(size_t count, absl::FunctionRef<bool()> stopped,
                                    absl::FunctionRef<bool()> is_enough);
  bool Begin(size_t i, absl::FunctionRef<bool()> stopped);
  bool SolvePlannedRow(size_t i, std::optional<SceneContact>& contact, const PlannedScene& planned,
                       absl::FunctionRef<bool()> stopped);
  void SetRow(size_t i, const Outcome& outcome);
  void SetBad(size_t i, RowStatus status);
  bool SetDerivatives(size_t i, absl::FunctionRef<bool()> stopped);
  void CheckNumbers(size_t i);

  void Finish(int64_t first, size_t at, size_t count, const RowSink& sink);
  void AddTo(SweepSummary& counts, int64_t first, size_t count) const;
  BadRow Describe(int64_t row, size_t i);
  Violation WhyInvalid(size_t i);

  const std::vector<std::string> field_names_;
  const std::vector<std::string> column_names_;
  const Demand demand_;  // With the effects that make the columns.
  DrivenScene driven_;
  const bool in_space_;
  const ColumnReader reader_;
  DerivativeColumns derivatives_;
  const std::vector<size_t> others_;  // The columns that are no derivatives.
  std::vector<double> numbers_;       // The columns of one row.

  // These are null if each row needs a scene of its own.
  std::unique_ptr<SceneLanes> lanes_;
  std::unique_ptr<LaneColumns> lane_columns_;

  SpatialLanes spatial_;                               // Rows that are solved together in space,
  std::vector<std::pair<size_t, size_t>> in_spatial_;  // and their numbers in the block, with their places there.

  // The current block.
  absl::Span<const FieldColumn> fields_;
  std::vector<double*> places_;        // The places of the first row's value in each column,
  std::vector<double*> other_places_;  // and in those that are no derivatives.
  // True if a column is an error of a mechanism's velocities or momentum, which needs the whole detail of an outcome.
  const bool asks_rates_errors_;
  const bool asks_free_end_;  // True if a column is a number of the free end.
  SceneLanes::Block block_;
  std::array<RowStatus, kBlock> statuses_;
  std::array<std::optional<size_t>, kBlock> too_large_;  // The column that makes a row not representable, if one does.
};

}  // namespace ricochet

#endif  // RICOCHET_CORE_ROWS_ROW_SOLVER_H_
