// Sweeps of planar contacts in lanes: the bits, regimes and tallies of Solve at every point, also at those that the
// lanes leave to their scenes.

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "core/rows/column.h"
#include "ricochet/solver.h"

namespace ricochet {
namespace {

// Columns that lanes give.
const std::vector<std::string>& LaneColumns() {
  static const std::vector<std::string> columns = {"contact_velocity_after.tangential_m_s[0]",
                                                   "impulse.tangential_n_s[0]", "work.tangential_total_j",
                                                   "coefficients.poisson"};
  return columns;
}

std::vector<double> Slips() {
  std::vector<double> slips;
  for (int i = 0; i < 41; ++i) slips.push_back(-1.0 + 0.0625 * i);
  return slips;
}

// Contacts that separate, slide, stop, have no friction, a W of rank one, or one that is not semidefinite.
SweepRequest Request(double tolerance) {
  return {.grid = {.scene = {.system = PlanarContact{2.0, 0.5, 1.0, 0.3, -1.0}, .restitution = PoissonCoefficient{0.6}},
                   .axes = {{"planar_contact.w_tn_per_kg", ListValues{{-1.5, -std::sqrt(2.0), -1.0, 0.0, 0.5}}},
                            {"planar_contact.normal_m_s", ListValues{{-1.0, 0.2}}},
                            {"friction.kinetic_coefficient", ListValues{{0.0, 1e-13, 0.2, 0.9}}},
                            {"planar_contact.tangential_m_s", ListValues{Slips()}}}},
          .columns = LaneColumns(),
          .with_regime = true,
          .demand = {.relative_tolerance = tolerance}};
}

// The scene of a point; the last axis runs fastest.
Scene SceneAt(const SweepRequest& request, size_t index) {
  const auto list = [&](size_t axis, size_t k) {
    return std::get<ListValues>(request.grid.axes[axis].values).values[k];
  };
  Scene scene = request.grid.scene;
  auto& contact = std::get<PlanarContact>(scene.system);
  contact.tangential_m_s = list(3, index % 41);
  scene.friction.kinetic_coefficient = list(2, index / 41 % 4);
  contact.normal_m_s = list(1, index / 41 / 4 % 2);
  contact.w_tn_per_kg = list(0, index / 41 / 8);
  return scene;
}

struct Sweep {
  std::vector<std::vector<double>> points;
  std::vector<Regime> regimes;
  SweepSummary summary;
};

Sweep Collected(const SweepRequest& request) {
  Sweep sweep;
  for (const absl::StatusOr<SweepChunk>& chunk : LocalSolver().Sweep(request)) {
    EXPECT_TRUE(chunk.ok()) << chunk.status();
    if (!chunk.ok()) break;
    const auto count = static_cast<size_t>(chunk->count);
    for (size_t i = 0; i < count; ++i) {
      std::vector<double>& point = sweep.points.emplace_back();
      for (size_t c = 0; c < LaneColumns().size(); ++c) point.push_back(chunk->values[c * count + i]);
    }
    sweep.regimes.insert(sweep.regimes.end(), chunk->regimes.begin(), chunk->regimes.end());
    if (chunk->summary.has_value()) sweep.summary = *chunk->summary;
  }
  return sweep;
}

TEST(PlanarSweepTest, HasTheBitsOfSolveAtEveryPoint) {
  for (const double tolerance : {1e-12, 1e-3, 0.0}) {
    const SweepRequest request = Request(tolerance);
    const Sweep sweep = Collected(request);
    ASSERT_EQ(sweep.points.size(), 5U * 2U * 4U * 41U);
    const ColumnReader reader(request.grid.scene, LaneColumns());
    std::vector<double> numbers;
    std::map<Model, int64_t> models;
    int64_t invalid = 0;
    for (size_t i = 0; i < sweep.points.size(); ++i) {
      const auto solved = LocalSolver().Solve({.scene = SceneAt(request, i), .demand = request.demand});
      if (!solved.ok()) {
        ++invalid;
        EXPECT_EQ(sweep.regimes[i], Regime::kInvalid) << i << ": " << solved.status();
        EXPECT_TRUE(std::isnan(sweep.points[i][0]));
        continue;
      }
      ++models[solved->outcome.plan.model];
      EXPECT_EQ(sweep.regimes[i], solved->outcome.regime) << i;
      reader.Read(solved->outcome, numbers);
      for (size_t c = 0; c < LaneColumns().size(); ++c) {
        EXPECT_EQ(std::bit_cast<uint64_t>(sweep.points[i][c]), std::bit_cast<uint64_t>(numbers[c]))
            << LaneColumns()[c] << " of point " << i;
      }
    }
    EXPECT_GT(invalid, 300);
    EXPECT_EQ(sweep.summary.by_regime[static_cast<size_t>(Regime::kInvalid)].count, invalid);
    for (const auto& [model, count] : models) {
      EXPECT_EQ(sweep.summary.by_model[static_cast<size_t>(model)].count, count) << static_cast<int>(model);
    }
    EXPECT_GE(models.size(), tolerance > 0.0 ? 3U : 2U);
  }
}

TEST(PlanarSweepTest, HasTheSameBitsFromAnyFirstPoint) {
  const Sweep whole = Collected(Request(1e-12));
  for (const int64_t first : {1, 255, 256, 700, 1639}) {
    SweepRequest request = Request(1e-12);
    request.first_index = first;
    const Sweep part = Collected(request);
    ASSERT_EQ(part.points.size() + static_cast<size_t>(first), whole.points.size());
    for (size_t i = 0; i < part.points.size(); ++i) {
      for (size_t c = 0; c < LaneColumns().size(); ++c) {
        EXPECT_EQ(std::bit_cast<uint64_t>(part.points[i][c]),
                  std::bit_cast<uint64_t>(whole.points[i + static_cast<size_t>(first)][c]))
            << i;
      }
    }
  }
}

}  // namespace
}  // namespace ricochet
