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

// The time that one impact takes, by order of magnitude on a processor of 2020.
enum class CostClass {
  kLine,      // One straight path without events: 2 ns in lanes, 30 to 100 ns alone.
  kEvents,    // A closed form whose events have to be proved: 4 to 20 ns in lanes, 25 to 400 ns alone.
  kForms,     // Formulas that have no lanes: 35 ns alone and in lanes.
  kSections,  // A path of sections, each with elementary functions or a series: 0.5 to 3 us.
  kSteps,     // An integrator's steps, some hundred: 100 to 500 us.
};

CostClass ClassOf(Model model, bool has_lanes) {
  switch (model) {
    case Model::kFrictionless:
    case Model::kFirstOrder:
      return has_lanes ? CostClass::kLine : CostClass::kForms;
    case Model::kSliding:
      return CostClass::kLine;
    case Model::kPendulum:
    case Model::kPlanar:
      return CostClass::kEvents;
    case Model::kFiniteDuration:
      return CostClass::kSteps;
    default:
      return CostClass::kSections;
  }
}

TEST(ModelOrderTest, ClassesOfCostDoNotDecreaseAlongTheCandidates) {
  const auto is_sorted = [](const auto& candidates, bool has_lanes) {
    return std::is_sorted(std::begin(candidates), std::end(candidates),
                          [has_lanes](const Candidate& one, const Candidate& other) {
                            return ClassOf(one.model, has_lanes) < ClassOf(other.model, has_lanes);
                          });
  };
  EXPECT_TRUE(is_sorted(kPlanarCandidates, true));
  EXPECT_TRUE(is_sorted(kPendulumCandidates, false));
  EXPECT_TRUE(is_sorted(kSpatialCandidates, true));
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
