// Batches of pendulums: every row has the bits of Solve, whichever model and arithmetic it calls for, and also where
// the lanes leave it to its scene.

#include <gtest/gtest.h>

#include <cmath>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "ricochet/solver.h"
#include "tests/support/scenes/batch_table.h"
#include "tests/support/scenes/laws_by_name.h"

namespace ricochet {
namespace {

struct Case {
  std::string law;
  double tolerance;
  std::optional<double> static_coefficient;
  std::vector<Effect> excluded;
};

// Rows of inertia, a, b, omega, mu and the coefficient: everyday ones and extreme ones, locked, separating, without
// friction or with so little that simpler models serve, and invalid ones.
class Rows {
 public:
  explicit Rows(unsigned seed) : random_(seed) {}

  std::vector<double> Next() {
    const double scale = OneIn(10) ? std::exp2(300.0 * Unit()) : 1.0;
    const double mu = OneIn(6) ? 0.0 : OneIn(3) ? std::exp2(-20.0 - 10.0 * Unit()) : std::fabs(Unit());
    std::vector<double> row = {
        scale * std::exp2(Unit()), std::exp2(Unit()), OneIn(20) ? 0.0 : 2.0 * Unit(), OneIn(10) ? Unit() : -1.0, mu,
        std::fabs(Unit())};
    if (OneIn(12)) row[random_() % row.size()] = OneIn(2) ? -1.0 : NAN;
    return row;
  }

 private:
  bool OneIn(unsigned count) { return random_() % count == 0; }
  double Unit() { return std::uniform_real_distribution<double>(-1.0, 1.0)(random_); }
  std::mt19937_64 random_;
};

Scene SceneOf(const std::vector<double>& row, const Case& with) {
  return {.system = Pendulum{row[0], row[1], row[2], row[3]},
          .friction = {.kinetic_coefficient = row[4], .static_coefficient = with.static_coefficient},
          .restitution = RestitutionOf(with.law, row[5])};
}

class PendulumBatch : public testing::TestWithParam<Case> {};

INSTANTIATE_TEST_SUITE_P(Laws, PendulumBatch,
                         testing::Values(Case{"newton", 1e-12, {}, {}}, Case{"poisson", 1e-12, {}, {}},
                                         Case{"energetic", 1e-12, {}, {}}, Case{"energetic", 0.0, {}, {}},
                                         Case{"energetic", 1e-3, {}, {}}, Case{"poisson", 1e-3, 0.5, {}},
                                         Case{"energetic", 1e-9, {}, {Effect::kFriction}}));

TEST_P(PendulumBatch, HasTheBitsOfSolveInEveryRow) {
  constexpr size_t kRows = 3000;
  const Case& with = GetParam();
  BatchTable table;
  table.setup = {.scene = SceneOf({1.0, 1.0, 1.0, -1.0, 0.1, 0.5}, with),
                 .fields = {"pendulum.inertia_kg_m2", "pendulum.a_m", "pendulum.b_m", "pendulum.omega_minus_rad_s",
                            "friction.kinetic_coefficient", "restitution." + with.law},
                 .columns = {"coefficients.newton", "work.friction_dissipation_j", "energy_change_j",
                             "work.tangential_spring_j", "impulse.tangential_n_s[0]", "rates_after_rad_s[0]"},
                 .demand = {.relative_tolerance = with.tolerance, .excluded = with.excluded}};
  Rows source(7);
  std::vector<std::vector<double>> rows;
  for (size_t i = 0; i < kRows; ++i) {
    rows.push_back(source.Next());
    table.Add(rows.back());
  }
  const auto response = table.Solve();
  ASSERT_TRUE(response.ok()) << response.status();
  RowCounts counts = ExpectBitsOfSolve(table, [&](size_t i) { return SceneOf(rows[i], with); });
  EXPECT_GT(counts.invalid, 50);
  EXPECT_GT(counts.models[Model::kNone], 20);
  if (with.excluded.empty()) {
    EXPECT_GT(counts.models[Model::kPendulum], 500);
  }
  for (const auto& [model, count] : counts.models) {
    EXPECT_GE(response->summary.counts.by_model[static_cast<size_t>(model)].count, count);
  }
}

}  // namespace
}  // namespace ricochet
