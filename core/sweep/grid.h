// The points of a grid: index i <-> the value of every axis.

#ifndef RICOCHET_CORE_SWEEP_GRID_H_
#define RICOCHET_CORE_SWEEP_GRID_H_

#include <cstdint>
#include <vector>

#include "absl/types/span.h"
#include "ricochet/error.h"
#include "ricochet/grid.h"

namespace ricochet {

// Every rule that the axes break (not the scene: core/sweep/sweep_run.h). Paths: "axes[0].linspace.count".
std::vector<Violation> ValidateAxes(const Grid& grid);

// Below here the axes are valid.

// Number of values of one axis.
int64_t AxisCount(const Axis& axis);

// Number of points of the grid.
int64_t PointCount(const Grid& grid);

// Value `i` of an axis, 0 <= i < AxisCount(axis). The same bits whichever points are asked for.
double AxisValue(const Axis& axis, int64_t i);

// The position on each axis of point `index`. `positions` has one entry an axis.
void AxisPositions(const Grid& grid, int64_t index, absl::Span<int64_t> positions);

}  // namespace ricochet

#endif  // RICOCHET_CORE_SWEEP_GRID_H_
