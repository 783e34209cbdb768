// PlanarRows: the rows of a batch of planar contacts, as the lanes (core/answer/planar_lanes.h) take them.

#ifndef RICOCHET_CORE_BATCH_PLANAR_ROWS_H_
#define RICOCHET_CORE_BATCH_PLANAR_ROWS_H_

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "core/answer/planar_lanes.h"
#include "core/plan/demand.h"
#include "ricochet/batch.h"
#include "ricochet/scene.h"

namespace ricochet {

class PlanarRows {
 public:
  static constexpr size_t kBlock = PlanarLanes::kBlock;
  using Block = PlanarLanes::Block;

  // `scene` is the base scene in which the setup's fields are resolved. Returns nothing if its rows cannot go this way.
  static std::optional<PlanarRows> Make(const Scene& scene, const BatchSetup& setup, const Demand& demand);

  // Solves the rows [first, first + count), of at most kBlock, as far as they are plain. Returns true if each has numbers
  // and all of them are finite.
  bool Solve(const BatchRows& rows, size_t first, size_t count, Block& block);

 private:
  explicit PlanarRows(PlanarLanes lanes) : lanes_(std::move(lanes)) {}
  PlanarLanes::Columns ColumnsOf(const BatchRows& rows, size_t first) const;

  PlanarLanes lanes_;
  std::array<std::optional<size_t>, PlanarLanes::kNumberCount> column_of_ = {};  // The input column of the number.
  bool static_is_kinetic_ = false;                                          // The scene states no static coefficient.
  std::array<std::array<double, kBlock>, PlanarLanes::kNumberCount> base_;  // The numbers that no column states.
  std::vector<double*> places_;                                             // Of the outputs of the current block.
};

}  // namespace ricochet

#endif  // RICOCHET_CORE_BATCH_PLANAR_ROWS_H_
