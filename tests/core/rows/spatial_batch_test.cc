// Batches and sweeps in space: every row and point has the bits of Solve, whatever the system and the place.

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "core/rows/column.h"
#include "ricochet/solver.h"
#include "tests/support/scenes/batch_table.h"
#include "tests/support/scenes/spatial_scenes.h"
#include "tests/support/scenes/system_scenes.h"

namespace ricochet {
namespace {

struct Case {
  const char* name;
  System system;
  std::vector<std::string> fields;  // Two components of slip, or of the velocity of a body.
  Restitution restitution;
  double tolerance;
};

std::vector<Case> Cases() {
  const std::vector<std::string> slip = {"spatial_contact.tangential_m_s[0]", "spatial_contact.tangential_m_s[1]"};
  const std::vector<std::string> body = {"spatial_body.linear_m_s[0]", "spatial_body.linear_m_s[1]"};
  const std::vector<std::string> pair = {"body_pair.spatial.body_1.linear_m_s[0]",
                                         "body_pair.spatial.body_2.angular_rad_s[1]"};
  const SpatialBody other = {2.0, {1, 0, 0, 1, 0, 1}, {0, 0, 0.5}, {0, 0, 1}, {1, 1, 0}};
  return {{"contact", ContactInSpace(), slip, EnergeticCoefficient{0.5}, 1e-6},
          {"contact_closely", ContactInSpace(), slip, PoissonCoefficient{0.7}, 1e-10},
          {"contact_exactly", ContactInSpace(), slip, NewtonCoefficient{0.3}, 0.0},
          {"contact_roughly", ContactInSpace(), slip, EnergeticCoefficient{0.0}, 1e-2},
          {"body", Body(), body, EnergeticCoefficient{0.5}, 1e-8},
          {"pair", BodyPair{SpatialPair{Body(), other}}, pair, PoissonCoefficient{0.5}, 1e-6}};
}

// Rows of one case with random numbers in its two fields and friction; some rows are invalid.
struct Rows : BatchTable {
  Rows(const Case& of, uint64_t seed, size_t count) : scene(With(of.system)) {
    scene.restitution = of.restitution;
    setup = {.scene = scene, .fields = of.fields, .columns = Columns(scene), .demand = {of.tolerance}};
    setup.fields.emplace_back("friction.kinetic_coefficient");
    spatial::SceneSource source(seed);
    in.resize(setup.fields.size());
    for (size_t i = 0; i < count; ++i) {
      for (size_t k = 0; k < 2; ++k) in[k].push_back(source.Below(20) == 0 ? 0.0 : source.Uniform(-2.0, 2.0));
      in[2].push_back(source.Below(20) == 0 ? 1e-13 : source.Below(40) == 0 ? -1.0 : source.Uniform(0.0, 3.0));
    }
  }

  // The scene of a row.
  Scene SceneOf(size_t i) const {
    Scene of_row = scene;
    if (auto* contact = std::get_if<SpatialContact>(&of_row.system)) contact->tangential_m_s = {in[0][i], in[1][i]};
    if (auto* body = std::get_if<SpatialBody>(&of_row.system)) {
      body->linear_m_s[0] = in[0][i];
      body->linear_m_s[1] = in[1][i];
    }
    if (auto* pair = std::get_if<BodyPair>(&of_row.system)) {
      std::get<SpatialPair>(pair->bodies).body_1.linear_m_s[0] = in[0][i];
      std::get<SpatialPair>(pair->bodies).body_2.angular_rad_s[1] = in[1][i];
    }
    of_row.friction.kinetic_coefficient = in[2][i];
    return of_row;
  }

  Scene scene;
};

class SpatialBatchTest : public testing::TestWithParam<Case> {};

INSTANTIATE_TEST_SUITE_P(Systems, SpatialBatchTest, testing::ValuesIn(Cases()),
                         [](const auto& test) { return std::string(test.param.name); });

TEST_P(SpatialBatchTest, EveryRowHasTheBitsOfSolve) {
  Rows rows(GetParam(), 7, 1500);
  const auto response = rows.Solve();
  ASSERT_TRUE(response.ok()) << response.status();
  RowCounts counts = ExpectBitsOfSolve(rows, [&](size_t i) { return rows.SceneOf(i); });
  const int64_t spatial = counts.models[Model::kSpatial];
  EXPECT_EQ(response->summary.counts.by_model[static_cast<size_t>(Model::kSpatial)].count, spatial);
  EXPECT_GT(spatial, 1000);
  EXPECT_GT(counts.invalid, 10);
  ASSERT_EQ(response->summary.bad_rows.size(), kMostBadRows);
  EXPECT_EQ(response->summary.bad_rows[0].field, "friction.kinetic_coefficient");
}

TEST_P(SpatialBatchTest, EveryPointOfASweepHasTheBitsOfItsRow) {
  Rows rows(GetParam(), 8, 700);
  for (double& friction : rows.in[2]) friction = std::fabs(friction);
  ASSERT_TRUE(rows.Solve().ok());
  ExpectBitsOfTheRowsInASweep(rows);
}

}  // namespace
}  // namespace ricochet
