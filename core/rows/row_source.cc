#include "core/rows/row_source.h"

#include <algorithm>
#include <bit>

#include "core/rows/axis_values.h"
#include "core/types/grid.h"

namespace ricochet {

// An axis of at most so many values is computed once for all points.
static constexpr int64_t kMostKept = 4096;

absl::Span<const FieldColumn> ArrayRows::At(int64_t first, size_t /*count*/) {
  for (size_t k = 0; k < columns_.size(); ++k) columns_[k].values = arrays_[k].data() + first;
  return columns_;
}

GridRows::GridRows(const Grid& grid) : runs_(grid.axes.size()), columns_(grid.axes.size()) {
  int64_t stride = 1;
  for (size_t k = grid.axes.size(); k-- > 0;) {
    Run& run = runs_[k];
    run.axis = &grid.axes[k];
    run.count = AxisCount(grid.axes[k]);
    run.stride = stride;
    if (stride == 1 && run.count <= kMostKept) {
      run.kept.resize(static_cast<size_t>(run.count));
      AxisValues(*run.axis, 0, absl::MakeSpan(run.kept));
    }
    if (grid.combination != Combination::kZip) stride *= run.count;
  }
}

absl::Span<const FieldColumn> GridRows::At(int64_t first, size_t count) {
  for (size_t k = 0; k < runs_.size(); ++k) columns_[k] = Drive(first, count, runs_[k]);
  return columns_;
}

// Fills the block with the value at a position.
void GridRows::Fill(Run& run, int64_t position) {
  const double value = AxisValue(*run.axis, position);
  const bool is_filled = run.alike.has_value() && std::bit_cast<uint64_t>(*run.alike) == std::bit_cast<uint64_t>(value);
  if (!is_filled) run.values.fill(value);
  run.alike = value;
}

// Writes the values of the axis from `position` on.
void GridRows::CopyFrom(int64_t position, size_t count, const Run& run, double* to) {
  if (run.kept.empty()) return AxisValues(*run.axis, position, absl::MakeSpan(to, count));
  std::copy_n(run.kept.begin() + position, count, to);
}

// Writes the values of the axis, one piece of points after another in which its position is the same or runs without a
// break.
FieldColumn GridRows::Drive(int64_t first, size_t count, Run& run) {
  const auto size = static_cast<int64_t>(count);
  int64_t position = first / run.stride % run.count;
  int64_t left = run.stride - first % run.stride;  // Points until the next position.
  const bool varies = left < size && run.count > 1;
  if (!varies) {
    Fill(run, position);
    return {.values = run.values.data(), .varies = false};
  }
  run.alike.reset();
  const bool runs = run.stride == 1;
  for (int64_t done = 0; done < size;) {
    const int64_t piece = std::min(runs ? run.count - position : left, size - done);
    double* const to = run.values.data() + done;
    if (runs) {
      CopyFrom(position, static_cast<size_t>(piece), run, to);
    } else {
      std::fill_n(to, piece, AxisValue(*run.axis, position));
    }
    done += piece;
    position = runs ? 0 : (position + 1) % run.count;
    left = run.stride;
  }
  return {.values = run.values.data(), .varies = true};
}

}  // namespace ricochet
