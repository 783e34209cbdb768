// The shape of a grid: which axes are valid, how many points they have, and where each point lies on them.

#ifndef RICOCHET_CORE_TYPES_GRID_H_
#define RICOCHET_CORE_TYPES_GRID_H_

#include <cstdint>
#include <string>
#include <vector>

#include "absl/types/span.h"
#include "ricochet/error.h"
#include "ricochet/grid.h"

namespace ricochet {

// Lists every rule that the axes and their combination break, by path ("axes[0].linspace.count"). Whether the scene has
// the fields that they drive is checked in core/rows/driven_scene.h.
std::vector<Violation> ValidateAxes(const Grid& grid);

// The paths of the axes.
std::vector<std::string> AxisPaths(const Grid& grid);

// The functions below take valid axes.

// Number of values of one axis.
int64_t AxisCount(const Axis& axis);

// Number of points of the grid.
int64_t PointCount(const Grid& grid);

// Writes the position of point `index` on each axis. `positions` has one entry an axis.
void AxisPositions(const Grid& grid, int64_t index, absl::Span<int64_t> positions);

}  // namespace ricochet

#endif  // RICOCHET_CORE_TYPES_GRID_H_
