// CheckedSweep and CheckedBatch: rows that have passed all checks, with the effects that make their columns.

#ifndef RICOCHET_CORE_ROWS_CHECKED_ROWS_H_
#define RICOCHET_CORE_ROWS_CHECKED_ROWS_H_

#include <cstdint>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "core/plan/demand.h"
#include "ricochet/batch.h"
#include "ricochet/grid.h"
#include "ricochet/scene.h"
#include "ricochet/sweep.h"

namespace ricochet {

struct CheckedSweep {
  Grid grid;
  Demand demand;  // With the effects that make the columns.
  bool with_regime = false;
  int64_t first = 0;  // The points are those with first <= index < end.
  int64_t end = 0;
  std::vector<std::string> columns;  // At least one.
  bool in_lanes = false;  // True if SIMD lanes give the columns, so that a point takes well below a microsecond.
};

// Errors: INVALID_ARGUMENT with every violation of the scene's undriven fields, the axes, the columns and the range.
absl::StatusOr<CheckedSweep> CheckSweep(const SweepRequest& request);

struct CheckedBatch {
  Scene scene;
  std::vector<std::string> fields;   // At least one.
  std::vector<std::string> columns;  // At least one.
  Demand demand;                     // With the effects that make the columns.
};

// Errors: INVALID_ARGUMENT with every violation of the setup. A rule of the scene that a column can cure is left to the
// rows.
absl::StatusOr<CheckedBatch> CheckBatch(const BatchSetup& setup);

}  // namespace ricochet

#endif  // RICOCHET_CORE_ROWS_CHECKED_ROWS_H_
