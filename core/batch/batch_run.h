// BatchRun: the rows of batches of one setup, solved one after another.

#ifndef RICOCHET_CORE_BATCH_BATCH_RUN_H_
#define RICOCHET_CORE_BATCH_BATCH_RUN_H_

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "absl/functional/function_ref.h"
#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "core/answer/spatial_lanes.h"
#include "core/batch/lane_rows.h"
#include "core/plan/demand.h"
#include "core/scene/driven_fields.h"
#include "core/sweep/column.h"
#include "ricochet/batch.h"
#include "ricochet/error.h"
#include "ricochet/outcome.h"
#include "ricochet/scene.h"

namespace ricochet {

class BatchRun {
 public:
  // Errors: INVALID_ARGUMENT with every violation of the setup. A rule of the scene that a column can cure is left to
  // the rows.
  static absl::StatusOr<std::unique_ptr<BatchRun>> Make(const BatchSetup& setup);

  BatchRun(const BatchRun&) = delete;
  BatchRun& operator=(const BatchRun&) = delete;

  // The columns in or out, whichever are more.
  size_t columns() const { return std::max(fields_.size(), columns_.size()); }

  // Solves all rows. `stopped` is asked before each row that goes alone, and before each block that goes in SIMD lanes.
  // Errors: INVALID_ARGUMENT if the columns do not fit, CANCELLED once `stopped` returns true.
  absl::StatusOr<BatchSummary> Solve(const BatchRows& rows, absl::FunctionRef<bool()> stopped);

 private:
  // The result of one row.
  struct Row {
    RowStatus status = RowStatus::kUnspecified;
    Regime regime = Regime::kInvalid;
    Model model = Model::kUnspecified;
    std::optional<size_t> too_large;  // The first column whose number exceeds the largest double.
  };

  explicit BatchRun(const BatchSetup& setup);
  absl::Status Prepare(const BatchSetup& setup);
  bool SetRow(const BatchRows& rows, size_t i);
  // A row on its way: its result, or its place among the spatial lanes.
  struct Begun {
    Row row;
    std::optional<size_t> lane;
  };
  std::optional<Begun> BeginRow(const BatchRows& rows, size_t i, absl::FunctionRef<bool()> stopped);
  Row RowOf(const BatchRows& rows, size_t i, const Outcome& outcome);
  void CheckNumbers(const BatchRows& rows, size_t i, Row& row) const;
  bool SolveBlock(const BatchRows& rows, size_t first, size_t count, absl::FunctionRef<bool()> stopped,
                  BatchSummary& summary);
  bool SolveScenes(const BatchRows& rows, size_t first, size_t count, absl::FunctionRef<bool()> stopped,
                   BatchSummary& summary);
  bool SolveSome(const BatchRows& rows, size_t first, size_t count, absl::FunctionRef<bool()> stopped,
                 BatchSummary& summary);
  void FinishBlock(const BatchRows& rows, size_t first, size_t count, BatchSummary& summary) const;
  void Finish(const BatchRows& rows, size_t i, const Row& row, BatchSummary& summary) const;
  Violation WhyInvalid(const BatchRows& rows, size_t i) const;
  BadRow Describe(const BatchRows& rows, int64_t index, const Row& row) const;

  Scene scene_;  // The scene of the current row, in which every row sets the same fields.
  DrivenFields fields_;
  Demand demand_;                     // With the effects that make the columns.
  bool has_relations_ = false;        // True if the scene has rules beyond those of single numbers.
  std::vector<std::string> names_;    // The names of the input columns.
  std::vector<std::string> columns_;  // The names of the output columns.
  std::optional<ColumnReader> reader_;
  std::vector<double> numbers_;      // The columns of one row.
  std::unique_ptr<LaneRows> lanes_;  // Null if the rows need a scene each.
  SpatialLanes spatial_;             // The rows of the current block that are solved together in space.
  std::vector<Begun> begun_;         // All rows of the current block that need a scene each.
};

}  // namespace ricochet

#endif  // RICOCHET_CORE_BATCH_BATCH_RUN_H_
