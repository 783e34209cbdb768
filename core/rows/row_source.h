// RowSource: where the rows of a sweep or of a batch come from. A row is a scene in which some fields have values of
// its own; a source gives these values block by block, a column for each field.

#ifndef RICOCHET_CORE_ROWS_ROW_SOURCE_H_
#define RICOCHET_CORE_ROWS_ROW_SOURCE_H_

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "absl/container/inlined_vector.h"
#include "absl/types/span.h"
#include "core/rows/scene_lanes.h"
#include "ricochet/grid.h"

namespace ricochet {

// The values of a field in the rows of a block.
struct FieldColumn {
  const double* values = nullptr;
  bool varies = true;  // False only if all values are the first.
};

class RowSource {
 public:
  static constexpr size_t kBlock = SceneLanes::kBlock;

  virtual ~RowSource() = default;

  // The values of each field in the rows [first, first + count), at most kBlock, until the next call.
  virtual absl::Span<const FieldColumn> At(int64_t first, size_t count) = 0;
};

// The rows of a batch: arrays of the caller.
class ArrayRows final : public RowSource {
 public:
  // The arrays must outlive this object.
  explicit ArrayRows(absl::Span<const absl::Span<const double>> arrays) : arrays_(arrays), columns_(arrays.size()) {}

  absl::Span<const FieldColumn> At(int64_t first, size_t count) override;

 private:
  const absl::Span<const absl::Span<const double>> arrays_;
  absl::InlinedVector<FieldColumn, 8> columns_;
};

// The points of a grid, in the order of their indices. Each axis is a field.
class GridRows final : public RowSource {
 public:
  // The axes of the grid are valid (core/types/grid.h). It must outlive this object.
  explicit GridRows(const Grid& grid);

  absl::Span<const FieldColumn> At(int64_t first, size_t count) override;

 private:
  // An axis: how it runs, and its values at the points of the current block.
  struct Run {
    const Axis* axis = nullptr;
    int64_t count = 0;
    int64_t stride = 0;           // Its position stays for so many points.
    std::vector<double> kept;     // The values of all positions, if they are asked for again and again and are few.
    std::optional<double> alike;  // The value at all points of the block; unset if they differ.
    std::array<double, kBlock> values;
  };

  static void Fill(Run& run, int64_t position);
  static void CopyFrom(int64_t position, size_t count, const Run& run, double* to);
  static FieldColumn Drive(int64_t first, size_t count, Run& run);

  std::vector<Run> runs_;  // One an axis.
  std::vector<FieldColumn> columns_;
};

}  // namespace ricochet

#endif  // RICOCHET_CORE_ROWS_ROW_SOURCE_H_
