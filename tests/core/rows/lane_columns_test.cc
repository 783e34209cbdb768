// The columns of points are the numbers of the scenes that the axes give, wherever a block begins.

#include "core/rows/lane_columns.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/rows/axis_values.h"
#include "core/rows/driven_scene.h"
#include "core/rows/row_source.h"
#include "core/types/grid.h"

namespace ricochet {
namespace {

Grid PendulumGrid(std::vector<Axis> axes, Combination combination = Combination::kProduct) {
  return {.scene = {.system = Pendulum{.inertia_kg_m2 = 2.0, .a_m = 0.3, .b_m = 1.0, .omega_minus_rad_s = -1.0},
                    .friction = {.kinetic_coefficient = 0.1},
                    .restitution = EnergeticCoefficient{1.0}},
          .axes = std::move(axes),
          .combination = combination};
}

// Compares blocks of `count` points, from point `first` on, with the scene driven to each point.
void ExpectColumnsOfScenes(const Grid& grid, int64_t first, size_t count) {
  DrivenScene driven(grid.scene, AxisPaths(grid));
  DrivenScene driven_by_columns(grid.scene, AxisPaths(grid));
  const auto lanes = SceneLanes::Make(driven.scene(), {{"energy_change_j"}}, {});
  ASSERT_NE(lanes, nullptr);
  GridRows source(grid);
  LaneColumns columns(*lanes, driven_by_columns);
  std::vector<int64_t> positions(grid.axes.size());
  for (int64_t at = first; at + static_cast<int64_t>(count) <= PointCount(grid); at += static_cast<int64_t>(count)) {
    const SceneLanes::Columns& found = columns.Of(source.At(at, count), count);
    for (size_t i = 0; i < count; ++i) {
      AxisPositions(grid, at + static_cast<int64_t>(i), absl::MakeSpan(positions));
      for (size_t k = 0; k < positions.size(); ++k) driven.Set(k, AxisValue(grid.axes[k], positions[k]));
      std::optional<SceneContact> contact;
      if (!driven.IsValid(contact)) continue;
      const SceneLanes::Numbers expected = lanes->NumbersOf(driven.scene());
      for (size_t n = 0; n < expected.size(); ++n) {
        const double number = found.of[n][i];
        ASSERT_EQ(std::bit_cast<uint64_t>(number), std::bit_cast<uint64_t>(expected[n])) << at << " " << i << " " << n;
        if (found.varies[n]) continue;
        ASSERT_EQ(number, found.of[n][0]);
      }
    }
  }
}

void ExpectColumnsInAnyBlocks(const Grid& grid) {
  for (const size_t count : {1u, 3u, 64u, 255u, 256u}) {
    for (const int64_t first : {0, 1, 7, 100}) ExpectColumnsOfScenes(grid, first, count);
  }
}

const Axis kList = {"pendulum.b_m", ListValues{{-1.0, 0.0, 0.5}}};
const Axis kLine = {"friction.kinetic_coefficient", Linspace{0.0, 0.4, 11}};
const Axis kLog = {"pendulum.inertia_kg_m2", Logspace{0.1, 10.0, 37}};
const Axis kLong = {"pendulum.omega_minus_rad_s", Linspace{-3.0, 1.0, 5000}};
const Axis kAngle = {"pendulum.phi_rad", Linspace{-0.1, 1.5, 29}};
const Axis kStatic = {"friction.static_coefficient", ListValues{{0.4, 0.5}}};
const Axis kNewton = {"restitution.newton", ListValues{{0.5, 0.7}}};

TEST(LaneColumnsTest, AnyAxisMayRunFastest) {
  ExpectColumnsInAnyBlocks(PendulumGrid({kList, kLine, kLog}));
  ExpectColumnsInAnyBlocks(PendulumGrid({kLog, kList, kLine}));
  ExpectColumnsInAnyBlocks(PendulumGrid({kLine, kLog, kList}));
  ExpectColumnsInAnyBlocks(PendulumGrid({kLong}));
  ExpectColumnsInAnyBlocks(PendulumGrid({kNewton, kLong, kStatic}));
}

TEST(LaneColumnsTest, AnAngleDrivesTwoNumbers) {
  ExpectColumnsInAnyBlocks(PendulumGrid({kAngle, kLog}));
  ExpectColumnsInAnyBlocks(PendulumGrid({kLog, kLine, kAngle}));
}

TEST(LaneColumnsTest, ZippedAxesAllRun) {
  ExpectColumnsInAnyBlocks(PendulumGrid(
      {{"friction.kinetic_coefficient", Linspace{0.0, 0.4, 600}}, {"pendulum.phi_rad", Logspace{0.1, 1.5, 600}}},
      Combination::kZip));
}

TEST(LaneColumnsTest, AnAngleBehindThePinGivesNumbersThatNoLanesTake) {
  const Grid grid = PendulumGrid({{"pendulum.phi_rad", ListValues{{-0.1, 1.0}}}});
  const auto lanes = SceneLanes::Make(grid.scene, {{"energy_change_j"}}, {});
  DrivenScene driven(grid.scene, AxisPaths(grid));
  GridRows source(grid);
  LaneColumns columns(*lanes, driven);
  const SceneLanes::Columns& found = columns.Of(source.At(0, 2), 2);
  const size_t a = 1;
  ASSERT_EQ(SceneLanes::PathsOf(grid.scene)[a], "pendulum.a_m");
  EXPECT_TRUE(std::isnan(found.of[a][0]));
  EXPECT_DOUBLE_EQ(found.of[a][1], std::sqrt(1.09) * std::sin(1.0));
}

TEST(LaneColumnsTest, PlanarContactsHaveColumns) {
  const Grid grid = {
      .scene = {.system = PlanarContact{2.0, 0.5, 1.0, 0.3, -1.0}, .restitution = PoissonCoefficient{0.6}},
      .axes = {{"restitution.poisson", Linspace{0.0, 1.0, 5}}, {"planar_contact.w_tn_per_kg", Linspace{0.0, 1.0, 77}}}};
  ExpectColumnsInAnyBlocks(grid);
}

}  // namespace
}  // namespace ricochet
