// CheckedSweep: a sweep that has passed the door, with its columns and its range resolved.

#ifndef RICOCHET_CORE_SWEEP_CHECKED_SWEEP_H_
#define RICOCHET_CORE_SWEEP_CHECKED_SWEEP_H_

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "core/plan/demand.h"
#include "ricochet/grid.h"
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

}  // namespace ricochet

#endif  // RICOCHET_CORE_SWEEP_CHECKED_SWEEP_H_
