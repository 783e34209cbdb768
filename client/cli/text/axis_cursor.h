// AxisCursor: the axis values of one point of a grid after another.

#ifndef RICOCHET_CLIENT_CLI_TEXT_AXIS_CURSOR_H_
#define RICOCHET_CLIENT_CLI_TEXT_AXIS_CURSOR_H_

#include <cstddef>
#include <cstdint>
#include <vector>

#include "absl/types/span.h"
#include "core/rows/axis_values.h"
#include "core/types/grid.h"

namespace ricochet::cli {

// It keeps the last value of each axis, because most stay the same for many points. `grid` must outlive it.
class AxisCursor {
 public:
  explicit AxisCursor(const Grid& grid)
      : grid_(&grid), positions_(grid.axes.size(), -1), next_(grid.axes.size()), values_(grid.axes.size()) {}

  const std::vector<double>& At(int64_t index) {
    AxisPositions(*grid_, index, absl::MakeSpan(next_));
    for (size_t i = 0; i < next_.size(); ++i) {
      if (next_[i] == positions_[i]) continue;
      positions_[i] = next_[i];
      values_[i] = AxisValue(grid_->axes[i], next_[i]);
    }
    return values_;
  }

 private:
  const Grid* grid_;
  std::vector<int64_t> positions_;
  std::vector<int64_t> next_;
  std::vector<double> values_;
};

}  // namespace ricochet::cli

#endif  // RICOCHET_CLIENT_CLI_TEXT_AXIS_CURSOR_H_
