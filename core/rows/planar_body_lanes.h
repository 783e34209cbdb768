// PlanarBodyLanes: scenes of one body or of two in a plane, each reduced to its contact, whose impact PlanarLanes
// solve.

#ifndef RICOCHET_CORE_ROWS_PLANAR_BODY_LANES_H_
#define RICOCHET_CORE_ROWS_PLANAR_BODY_LANES_H_

#include <array>
#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "absl/types/span.h"
#include "core/plan/demand.h"
#include "core/rows/scene_lanes.h"
#include "ricochet/scene.h"

namespace ricochet {

class PlanarBodyLanes : public SceneLanes {
 public:
  // Returns null if PlanarLanes do not give every column that is not a velocity of a body.
  static std::unique_ptr<SceneLanes> Make(const Scene& scene, absl::Span<const std::string> columns,
                                          const Demand& demand);

  void Solve(const Columns& columns, size_t count, absl::Span<double* const> places, Block& block) override;

 private:
  using Column = std::array<double, kBlock>;

  // A column of the answer that is a velocity of a body after the impact.
  struct AfterColumn {
    size_t column;
    size_t body;
    size_t component;  // 0 along t, 1 along n, 2 the rate.
  };
  struct ContactColumns {
    Column wtt, wtn, wnn, u0, v0;
  };

  explicit PlanarBodyLanes(size_t bodies);

  void SetColumns(absl::Span<const std::string> columns);
  size_t ContactColumn(const char* path);
  void Reduce(const Columns& columns, size_t count);
  Columns ContactOf(const Columns& columns) const;
  void SetAfter(const AfterColumn& after, const Columns& columns, size_t count, double* to) const;

  size_t bodies_;
  std::unique_ptr<SceneLanes> contact_lanes_;
  ContactColumns contact_ = {};

  // The columns that the lanes of the contact give, with the place of each in the answer; kOwn for one that is not in
  // it.
  static constexpr size_t kOwn = static_cast<size_t>(-1);
  std::vector<std::string> contact_paths_;
  std::vector<size_t> column_of_;
  std::vector<AfterColumn> after_;
  size_t tangential_impulse_ = kOwn, normal_impulse_ = kOwn;  // Their numbers among contact_paths_.
  std::array<Column, 2> own_ = {};
  std::vector<double*> contact_places_;
};

}  // namespace ricochet

#endif  // RICOCHET_CORE_ROWS_PLANAR_BODY_LANES_H_
