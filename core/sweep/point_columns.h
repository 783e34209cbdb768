// PointColumns: the numbers of consecutive points of a grid, column by column, as SIMD lanes take them.

#ifndef RICOCHET_CORE_SWEEP_POINT_COLUMNS_H_
#define RICOCHET_CORE_SWEEP_POINT_COLUMNS_H_

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "absl/container/inlined_vector.h"
#include "core/answer/scene_lanes.h"
#include "core/scene/driven_fields.h"
#include "ricochet/grid.h"
#include "ricochet/scene.h"

namespace ricochet {

class PointColumns {
 public:
  // The lanes take fields (SceneLanes::TakesFields) and are those of the grid's scene, whose axes are valid. Both must
  // outlive this object.
  PointColumns(const Grid& grid, const SceneLanes& lanes);
  PointColumns(const PointColumns&) = delete;
  PointColumns& operator=(const PointColumns&) = delete;

  // The numbers of the points [first, first + count), at most SceneLanes::kBlock, until the next call. A number that its
  // axis may not have is in the column as it is, or as NaN if the field is not a number of the lanes.
  const SceneLanes::Columns& At(int64_t first, size_t count);

 private:
  // How an axis runs: its position stays for `stride` points.
  struct Run {
    const Axis* axis;
    const Field* field;
    int64_t count;
    int64_t stride;
    std::vector<size_t> numbers;  // One, or several if the field is derived.
    std::vector<double> values;   // Those of all positions, if they are asked for again and again and are few.
  };

  // A number for each of those that an axis drives.
  using Driven = absl::InlinedVector<double, 2>;

  Driven DrivenAt(const Run& run, int64_t position) const;
  void Drive(const Run& run, int64_t first, size_t count);
  void Hold(size_t number, double value);
  void HoldAt(const Run& run, int64_t position);
  void PutAlike(const Run& run, int64_t position, size_t from, size_t count);
  void PutRunning(const Run& run, int64_t position, size_t from, size_t count);

  const SceneLanes& lanes_;
  Scene scene_;
  DrivenFields fields_;
  std::vector<Run> runs_;
  bool static_is_kinetic_ = false;
  SceneLanes::Columns columns_;
  std::array<std::array<double, SceneLanes::kBlock>, SceneLanes::kMostNumbers> numbers_;
  std::array<std::optional<double>, SceneLanes::kMostNumbers> held_;  // The number that fills the column, if it is one.
};

}  // namespace ricochet

#endif  // RICOCHET_CORE_SWEEP_POINT_COLUMNS_H_
