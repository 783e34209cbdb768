// LaneRows: the rows of a batch as SIMD lanes (core/answer/scene_lanes.h) take them.

#ifndef RICOCHET_CORE_BATCH_LANE_ROWS_H_
#define RICOCHET_CORE_BATCH_LANE_ROWS_H_

#include <array>
#include <cstddef>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "core/answer/scene_lanes.h"
#include "core/plan/demand.h"
#include "ricochet/batch.h"
#include "ricochet/scene.h"

namespace ricochet {

class LaneRows {
 public:
  static constexpr size_t kBlock = SceneLanes::kBlock;

  // `scene` is the base scene in which the setup's fields are resolved. Returns null if its rows cannot go this way.
  static std::unique_ptr<LaneRows> Make(const Scene& scene, const BatchSetup& setup, const Demand& demand);

  // Solves the rows [first, first + count), of at most kBlock, as far as they are plain.
  void Solve(const BatchRows& rows, size_t first, size_t count);

  // The rows solved last.
  const SceneLanes::Block& block() const { return block_; }

 private:
  explicit LaneRows(std::unique_ptr<SceneLanes> lanes) : lanes_(std::move(lanes)) {}
  SceneLanes::Columns ColumnsOf(const BatchRows& rows, size_t first) const;

  std::unique_ptr<SceneLanes> lanes_;
  std::array<std::optional<size_t>, SceneLanes::kMostNumbers> column_of_ = {};  // The input column of the number.
  bool static_is_kinetic_ = false;                                         // The scene states no static coefficient.
  std::array<std::array<double, kBlock>, SceneLanes::kMostNumbers> base_;  // The numbers that no column states.
  std::vector<double*> places_;                                            // Of the outputs of the current block.
  SceneLanes::Block block_;
};

}  // namespace ricochet

#endif  // RICOCHET_CORE_BATCH_LANE_ROWS_H_
