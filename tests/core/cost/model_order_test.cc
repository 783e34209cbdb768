// Tests the order in which a plan tries the models of a contact (core/plan/candidates.h). Times are compared with those
// that `cost` measures by `./dev bench`; errors are compared here.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <iterator>
#include <limits>
#include <vector>

#include "core/cost/cost.h"
#include "core/plan/candidates.h"
#include "tests/support/scenes/system_scenes.h"

namespace ricochet {
namespace {

std::vector<CostRow> RowsOf(const Scene& scene) {
  auto study = CostStudy::Make({.scene = scene, .time_limit_s = 2.0});
  EXPECT_TRUE(study.ok()) << study.status();
  std::vector<CostRow> rows;
  while (study.ok() && !study->ended()) {
    const auto chunk = study->NextChunk([] { return false; });
    EXPECT_TRUE(chunk.ok());
    if (!chunk.ok()) break;
    rows.insert(rows.end(), chunk->rows.begin(), chunk->rows.end());
  }
  return rows;
}

// The least error of a model in any row of plain arithmetic.
double ErrorOf(Model model, const std::vector<CostRow>& rows) {
  double least = std::numeric_limits<double>::infinity();
  for (const CostRow& row : rows) {
    const bool is_plain = row.method.model == model && row.method.arithmetic == Arithmetic::kPlain;
    if (is_plain && row.achieved.has_value()) least = std::min(least, row.achieved->total);
  }
  return least;
}

TEST(ModelOrderTest, ClassesOfCostDoNotDecreaseAlongTheCandidates) {
  const auto is_cheaper = [](const Candidate& one, const Candidate& other) { return one.cost < other.cost; };
  EXPECT_TRUE(std::is_sorted(std::begin(kPlanarCandidates), std::end(kPlanarCandidates), is_cheaper));
  EXPECT_TRUE(std::is_sorted(std::begin(kPendulumCandidates), std::end(kPendulumCandidates), is_cheaper));
  EXPECT_TRUE(std::is_sorted(std::begin(kSpatialCandidates), std::end(kSpatialCandidates), is_cheaper));
}

// The reason why a plan takes the closed form at every tolerance: it is the cheaper one, too.
TEST(ModelOrderTest, TheFormsOfAPendulumAreFarLessExactThanItsClosedForm) {
  Scene scene = With(Pendulum{1.0, 1.0, 0.3, -1.0});
  scene.friction.kinetic_coefficient = 0.2;
  const std::vector<CostRow> rows = RowsOf(scene);
  const double closed = ErrorOf(Model::kPendulum, rows);
  for (const Model form : {Model::kFrictionless, Model::kFirstOrder}) {
    EXPECT_LT(ErrorOf(form, rows), std::numeric_limits<double>::infinity());
    EXPECT_LT(closed, 1e-6 * ErrorOf(form, rows));
  }
}

}  // namespace
}  // namespace ricochet
