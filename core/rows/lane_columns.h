// LaneColumns: the numbers of rows, column by column, as SIMD lanes take them, from the values of their fields.

#ifndef RICOCHET_CORE_ROWS_LANE_COLUMNS_H_
#define RICOCHET_CORE_ROWS_LANE_COLUMNS_H_

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "absl/types/span.h"
#include "core/rows/driven_scene.h"
#include "core/rows/row_source.h"
#include "core/rows/scene_lanes.h"

namespace ricochet {

class LaneColumns {
 public:
  // The lanes are those of the scene that is driven. Both must outlive this object.
  LaneColumns(const SceneLanes& lanes, DrivenScene& driven);
  LaneColumns(const LaneColumns&) = delete;
  LaneColumns& operator=(const LaneColumns&) = delete;

  // The numbers of `count` rows, at most SceneLanes::kBlock, until the next call. A number that its field may not have
  // is in the column as it is, or as NaN if the field is not a number of the lanes.
  const SceneLanes::Columns& Of(absl::Span<const FieldColumn> fields, size_t count);

 private:
  void SetField(size_t k, const FieldColumn& field, size_t count);
  void SetDerived(size_t k, double value, size_t from, size_t count);
  void SetFromScenes(absl::Span<const FieldColumn> fields, size_t count);

  const SceneLanes& lanes_;
  DrivenScene& driven_;
  bool static_is_kinetic_ = false;                 // The scene states no static coefficient.
  size_t static_ = 0;                              // The place of static friction among the numbers.
  std::vector<std::vector<size_t>> numbers_of_;    // Each field sets these: one, or several if it is derived.
  std::vector<std::optional<double>> derived_of_;  // The value that fills a derived field's columns, if one does.
  SceneLanes::Columns columns_;
  std::array<std::array<double, SceneLanes::kBlock>, SceneLanes::kMostNumbers> numbers_;
};

}  // namespace ricochet

#endif  // RICOCHET_CORE_ROWS_LANE_COLUMNS_H_
