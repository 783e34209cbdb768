// Compares the order in which a plan tries the models of a contact (core/plan/candidates.h) with the times that `cost`
// measures. Only models whose times are far apart in the same run are compared.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <vector>

#include "absl/types/span.h"
#include "core/cost/cost.h"
#include "core/plan/candidates.h"
#include "tests/support/scenes/system_scenes.h"

namespace ricochet {
namespace {

constexpr double kFarApart = 2.0;

// The least time of a model in any row, and the error that it has then.
struct Measured {
  double alone_s = std::numeric_limits<double>::infinity();
  double batch_s = std::numeric_limits<double>::infinity();
  double error = std::numeric_limits<double>::infinity();

  bool is_known() const { return error < std::numeric_limits<double>::infinity(); }
};

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

Measured Of(Model model, const std::vector<CostRow>& rows) {
  Measured least;
  for (const CostRow& row : rows) {
    const bool is_usual = row.method.model == model && row.method.arithmetic == Arithmetic::kPlain;
    if (!is_usual || !row.solve.has_value() || !row.achieved.has_value()) continue;
    if (row.solve->median_s >= least.alone_s) continue;
    least = {.alone_s = row.solve->median_s,
             .batch_s = row.batch.has_value() ? row.batch->median_s : row.solve->median_s,
             .error = row.achieved->total};
  }
  return least;
}

// Of two candidates, the one that comes first is not the slower one by far.
void ExpectOrder(absl::Span<const Candidate> candidates, const Scene& scene) {
  const std::vector<CostRow> rows = RowsOf(scene);
  int compared = 0;
  for (size_t later = 1; later < candidates.size(); ++later) {
    for (size_t first = 0; first < later; ++first) {
      const Measured cheap = Of(candidates[first].model, rows);
      const Measured expensive = Of(candidates[later].model, rows);
      if (!cheap.is_known() || !expensive.is_known()) continue;
      EXPECT_LT(cheap.alone_s, kFarApart * expensive.alone_s) << first << " before " << later;
      ++compared;
    }
  }
  EXPECT_GE(compared, 3);
}

Scene Compliant(Scene scene) {
  scene.compliance = {.tangential_ratio_squared = 1.5, .normal = LinearSpring{1e6}};
  return scene;
}

TEST(ModelOrderTest, ClassesOfCostDoNotDecreaseAlongTheCandidates) {
  const auto is_cheaper = [](const Candidate& one, const Candidate& other) { return one.cost < other.cost; };
  EXPECT_TRUE(std::is_sorted(std::begin(kPlanarCandidates), std::end(kPlanarCandidates), is_cheaper));
  EXPECT_TRUE(std::is_sorted(std::begin(kPendulumCandidates), std::end(kPendulumCandidates), is_cheaper));
  EXPECT_TRUE(std::is_sorted(std::begin(kSpatialCandidates), std::end(kSpatialCandidates), is_cheaper));
}

TEST(ModelOrderTest, IsThatOfTheMeasuredTimes) {
  Scene slides = With(PlanarContact{1.2, 0.3, 1.0, 3.0, -1.0});
  slides.friction.kinetic_coefficient = 0.1;
  ExpectOrder(kPlanarCandidates, Compliant(slides));
  Scene pendulum = With(Pendulum{1.0, 1.0, 0.3, -1.0});
  pendulum.friction.kinetic_coefficient = 0.2;
  ExpectOrder(kPendulumCandidates, Compliant(pendulum));
  ExpectOrder(kSpatialCandidates, With(ContactInSpace()));
}

// The reason why a plan takes the closed form at every tolerance.
TEST(ModelOrderTest, TheFormsOfAPendulumAreBeatenInTimeAndInError) {
  Scene scene = With(Pendulum{1.0, 1.0, 0.3, -1.0});
  scene.friction.kinetic_coefficient = 0.2;
  const std::vector<CostRow> rows = RowsOf(scene);
  const Measured closed = Of(Model::kPendulum, rows);
  for (const Model model : {Model::kFrictionless, Model::kFirstOrder}) {
    const Measured form = Of(model, rows);
    ASSERT_TRUE(form.is_known());
    EXPECT_LT(closed.error, 1e-6 * form.error);
    EXPECT_LT(closed.batch_s, form.batch_s);  // A ninth with AVX2.
  }
}

}  // namespace
}  // namespace ricochet
