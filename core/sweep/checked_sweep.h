// CheckedSweep: a sweep that has passed the door, with its columns and its range resolved.

#ifndef RICOCHET_CORE_SWEEP_CHECKED_SWEEP_H_
#define RICOCHET_CORE_SWEEP_CHECKED_SWEEP_H_

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "absl/status/statusor.h"
#include "core/models/pendulum/pendulum.h"
#include "core/models/planar_outputs.h"
#include "core/plan/demand.h"
#include "ricochet/grid.h"
#include "ricochet/sweep.h"

namespace ricochet {

struct CheckedSweep {
  Grid grid;
  Demand demand;
  bool with_regime = false;
  int64_t first = 0;  // The points are those with first <= index < end.
  int64_t end = 0;
  size_t columns = 0;                     // Number of columns, at least one.
  bool in_lanes = false;                  // True if the pendulum's SIMD lanes give every column.
  std::vector<pendulum::Output> outputs;  // The columns, if the lanes give them.
  std::vector<size_t> positions;          // Else the columns' positions in Columns(scene).
  // The columns, if the lanes of planar contacts give them; points that these leave out are read at `positions`.
  std::optional<std::vector<PlanarOutput>> planar_outputs;

  // True if a point takes well below a microsecond.
  bool is_fast() const { return in_lanes || planar_outputs.has_value(); }
};

// Errors: INVALID_ARGUMENT with every violation of the scene's undriven fields, the axes, the columns and the range.
absl::StatusOr<CheckedSweep> CheckSweep(const SweepRequest& request);

}  // namespace ricochet

#endif  // RICOCHET_CORE_SWEEP_CHECKED_SWEEP_H_
