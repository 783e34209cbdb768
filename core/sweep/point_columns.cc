#include "core/sweep/point_columns.h"

#include <algorithm>
#include <limits>
#include <string>

#include "absl/strings/str_cat.h"
#include "absl/types/span.h"
#include "core/sweep/grid.h"

namespace ricochet {

// An axis of at most so many values is computed once for all points.
static constexpr int64_t kMostKept = 4096;

PointColumns::PointColumns(const Grid& grid, const SceneLanes& lanes)
    : lanes_(lanes),
      scene_(grid.scene),
      fields_(
          AxisPaths(grid), [](size_t i) { return absl::StrCat("axes[", i, "]"); }, ".path", scene_),
      static_is_kinetic_(!scene_.friction.static_coefficient.has_value()) {
  const SceneLanes::Numbers numbers = lanes_.NumbersOf(scene_);
  for (size_t n = 0; n < numbers.size(); ++n) Hold(n, numbers[n]);
  int64_t stride = 1;
  for (size_t k = grid.axes.size(); k-- > 0;) {
    Run run = {.axis = &grid.axes[k], .field = &fields_[k], .count = AxisCount(grid.axes[k]), .stride = stride};
    for (const std::string& path : fields_[k].sets()) run.numbers.push_back(*lanes_.NumberAt(path));
    if (stride == 1 && run.count <= kMostKept && run.numbers.size() == 1) {
      run.values.resize(static_cast<size_t>(run.count));
      AxisValues(*run.axis, 0, absl::MakeSpan(run.values));
    }
    if (grid.combination != Combination::kZip) stride *= run.count;
    runs_.push_back(std::move(run));
  }
}

void PointColumns::Hold(size_t number, double value) {
  if (held_[number] != value) numbers_[number].fill(value);
  held_[number] = value;
  columns_.of[number] = numbers_[number].data();
  columns_.varies[number] = false;
}

const SceneLanes::Columns& PointColumns::At(int64_t first, size_t count) {
  for (const Run& run : runs_) Drive(run, first, count);
  if (static_is_kinetic_) lanes_.TakeStaticFromKinetic(columns_);
  return columns_;
}

// Returns the numbers that the axis drives at a position, NaN if the field may not have its value there.
PointColumns::Driven PointColumns::DrivenAt(const Run& run, int64_t position) const {
  const double value = AxisValue(*run.axis, position);
  if (run.numbers.size() == 1) return {value};
  if (!run.field->Set(value)) return Driven(run.numbers.size(), std::numeric_limits<double>::quiet_NaN());
  const SceneLanes::Numbers numbers = lanes_.NumbersOf(scene_);
  Driven driven;
  for (const size_t number : run.numbers) driven.push_back(numbers[number]);
  return driven;
}

void PointColumns::HoldAt(const Run& run, int64_t position) {
  const Driven driven = DrivenAt(run, position);
  for (size_t k = 0; k < driven.size(); ++k) Hold(run.numbers[k], driven[k]);
}

void PointColumns::PutAlike(const Run& run, int64_t position, size_t from, size_t count) {
  const Driven driven = DrivenAt(run, position);
  for (size_t k = 0; k < driven.size(); ++k) std::fill_n(numbers_[run.numbers[k]].data() + from, count, driven[k]);
}

// Writes the values of the axis from `position` on.
void PointColumns::PutRunning(const Run& run, int64_t position, size_t from, size_t count) {
  double* const to = numbers_[run.numbers[0]].data() + from;
  if (!run.values.empty()) {
    std::copy_n(run.values.begin() + position, count, to);
    return;
  }
  if (run.numbers.size() == 1) return AxisValues(*run.axis, position, absl::MakeSpan(to, count));
  for (size_t i = 0; i < count; ++i) PutAlike(run, position + static_cast<int64_t>(i), from + i, 1);
}

// Writes what the axis drives, one piece of points after another in which its position is the same or runs without a break.
void PointColumns::Drive(const Run& run, int64_t first, size_t count) {
  const auto size = static_cast<int64_t>(count);
  int64_t position = first / run.stride % run.count;
  int64_t left = run.stride - first % run.stride;  // Points until the next position.
  const bool varies = left < size && run.count > 1;
  if (!varies) return HoldAt(run, position);
  for (const size_t number : run.numbers) {
    columns_.varies[number] = true;
    held_[number].reset();
  }
  for (int64_t done = 0; done < size;) {
    const bool runs = run.stride == 1;
    const int64_t piece = std::min(runs ? run.count - position : left, size - done);
    const auto from = static_cast<size_t>(done);
    if (runs) {
      PutRunning(run, position, from, static_cast<size_t>(piece));
    } else {
      PutAlike(run, position, from, static_cast<size_t>(piece));
    }
    done += piece;
    position = runs ? 0 : (position + 1) % run.count;
    left = run.stride;
  }
}

}  // namespace ricochet
