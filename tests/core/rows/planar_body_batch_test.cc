// Batches and sweeps of one body and of two in a plane: every row and point has the bits of Solve, also where the lanes
// leave it to its scene.

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "ricochet/solver.h"
#include "tests/support/scenes/batch_table.h"
#include "tests/support/scenes/laws_by_name.h"

namespace ricochet {
namespace {

constexpr const char* kBodyFields[] = {"mass_kg",        "inertia_com_kg_m2", "offset_t_m", "offset_n_m",
                                       "velocity_t_m_s", "velocity_n_m_s",    "rate_rad_s"};

struct Case {
  size_t bodies;
  std::string law;
  double tolerance;
};

// Numbers of bodies: everyday ones and extreme ones, with the contact above the centre of mass, nearly massless,
// separating and invalid.
class Numbers {
 public:
  explicit Numbers(unsigned seed) : random_(seed) {}

  std::vector<double> Row(size_t bodies) {
    std::vector<double> row;
    for (size_t body = 0; body < bodies; ++body) {
      const double scale = OneIn(12) ? std::exp2(300.0 * Unit()) : 1.0;
      const double side = body == 0 ? 1.0 : -1.0;
      row.insert(row.end(), {scale * std::exp2(Unit()), scale * std::exp2(Unit()), OneIn(8) ? 0.0 : 2.0 * Unit(),
                             OneIn(8) ? -0.0 : side * -2.0 * std::fabs(Unit()), OneIn(8) ? 0.0 : 2.0 * Unit(),
                             side * (OneIn(8) ? 1.0 : -1.0) * std::fabs(Unit()), OneIn(3) ? 0.0 : Unit()});
    }
    row.push_back(OneIn(8) ? 0.0 : OneIn(8) ? 1e-13 : OneIn(4) ? 5.0 * std::fabs(Unit()) : std::fabs(Unit()));
    row.push_back(OneIn(8) ? 0.0 : std::fabs(Unit()));
    constexpr double kOdd[] = {-1.0, NAN, INFINITY, 0.0};
    if (OneIn(12)) row[random_() % row.size()] = kOdd[random_() % 4];
    return row;
  }

 private:
  bool OneIn(unsigned count) { return random_() % count == 0; }
  double Unit() { return std::uniform_real_distribution<double>(-1.0, 1.0)(random_); }
  std::mt19937_64 random_;
};

PlanarBody BodyFrom(const double* row) { return {row[0], row[1], row[2], row[3], row[4], row[5], row[6]}; }

Scene SceneOf(const std::vector<double>& row, const Case& with) {
  Scene scene;
  const double* const rest = row.data() + 7 * with.bodies;
  if (with.bodies == 1) {
    scene.system = BodyFrom(row.data());
  } else {
    scene.system = BodyPair{PlanarPair{BodyFrom(row.data()), BodyFrom(row.data() + 7)}};
  }
  scene.friction.kinetic_coefficient = rest[0];
  scene.restitution = RestitutionOf(with.law, rest[1]);
  return scene;
}

BatchTable Table(const Case& with, size_t rows) {
  BatchTable table;
  BatchSetup& setup = table.setup;
  for (size_t body = 0; body < with.bodies; ++body) {
    const std::string prefix = with.bodies == 1 ? "planar_body."
                               : body == 0      ? "body_pair.planar.body_1."
                                                : "body_pair.planar.body_2.";
    for (const char* field : kBodyFields) setup.fields.push_back(prefix + field);
    const std::string after = "bodies_after[" + std::to_string(body) + "].";
    for (const char* column : {"linear_m_s[1]", "angular_rad_s[0]", "linear_m_s[0]"})
      setup.columns.push_back(after + column);
  }
  setup.fields.insert(setup.fields.end(), {"friction.kinetic_coefficient", "restitution." + with.law});
  setup.columns.insert(setup.columns.begin() + 1, {"contact_velocity_after.tangential_m_s[0]", "energy_change_j"});
  setup.demand.relative_tolerance = with.tolerance;
  Numbers numbers(3);
  setup.scene = SceneOf(std::vector<double>(7 * with.bodies + 2, 0.5), with);
  for (size_t i = 0; i < rows; ++i) table.Add(numbers.Row(with.bodies));
  return table;
}

std::vector<double> RowAt(const BatchTable& table, size_t i) {
  std::vector<double> row;
  for (const auto& column : table.in) row.push_back(column[i]);
  return row;
}

class PlanarBodyBatch : public testing::TestWithParam<Case> {};

INSTANTIATE_TEST_SUITE_P(Systems, PlanarBodyBatch,
                         testing::Values(Case{1, "newton", 1e-12}, Case{1, "energetic", 1e-12}, Case{1, "poisson", 0.0},
                                         Case{2, "energetic", 1e-12}, Case{2, "poisson", 1e-3}));

TEST_P(PlanarBodyBatch, HasTheBitsOfSolveInEveryRow) {
  BatchTable table = Table(GetParam(), 3000);
  const auto response = table.Solve();
  ASSERT_TRUE(response.ok()) << response.status();
  RowCounts counts = ExpectBitsOfSolve(table, [&](size_t i) { return SceneOf(RowAt(table, i), GetParam()); });
  EXPECT_GT(counts.invalid, 50);
  for (const Model model : {Model::kPlanar, Model::kNone})
    EXPECT_GT(counts.models[model], 100) << static_cast<int>(model);
  if (GetParam().tolerance > 0.0) {
    for (const Model model : {Model::kSliding, Model::kFrictionless}) {
      EXPECT_GT(counts.models[model], 50) << static_cast<int>(model);
    }
  }
  for (const auto& [model, count] : counts.models) {
    EXPECT_GE(response->summary.counts.by_model[static_cast<size_t>(model)].count, count);
  }
}

TEST_P(PlanarBodyBatch, HasTheBitsOfItsRowsInASweep) {
  BatchTable table = Table(GetParam(), 700);
  for (std::vector<double>& column : table.in) {
    // An axis holds finite numbers.
    for (double& number : column) number = std::isfinite(number) ? number : 0.25;
  }
  ASSERT_TRUE(table.Solve().ok());
  ExpectBitsOfTheRowsInASweep(table);
}

}  // namespace
}  // namespace ricochet
