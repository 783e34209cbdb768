// A study of cost: every method is there, its errors are those of the paper, and every claim is kept.

#include "core/cost/cost.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <string>
#include <vector>

#include "core/certified/certified.h"
#include "core/cost/cost_kernel.h"
#include "core/cost/cost_summary.h"
#include "core/cost/methods_by_model.h"
#include "core/models/finite_duration/finite_duration.h"
#include "ricochet/error.h"
#include "ricochet/solver.h"
#include "tests/support/scenes/multi_contact_scenes.h"
#include "tests/support/scenes/system_scenes.h"

namespace ricochet {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::ElementsAre;
using testing::Field;
using testing::HasSubstr;
using testing::IsSupersetOf;
using testing::Not;

bool Never() { return false; }

struct Study {
  std::vector<CostRow> rows;
  CostSummary summary;

  const CostRow& operator[](const std::string& name) const {
    const auto row = std::find_if(rows.begin(), rows.end(), [&](const CostRow& one) { return one.name == name; });
    EXPECT_NE(row, rows.end()) << name;
    return row == rows.end() ? rows.front() : *row;
  }
  std::vector<std::string> Names() const {
    std::vector<std::string> names;
    for (const CostRow& row : rows) names.push_back(row.name);
    return names;
  }
};

Study StudyOf(const CostRequest& request) {
  Study result;
  absl::StatusOr<CostStudy> study = CostStudy::Make(request);
  EXPECT_TRUE(study.ok()) << study.status();
  while (study.ok() && !study->ended()) {
    absl::StatusOr<CostChunk> chunk = study->NextChunk(Never);
    EXPECT_TRUE(chunk.ok()) << chunk.status();
    if (!chunk.ok()) break;
    EXPECT_EQ(chunk->first_row, static_cast<int64_t>(result.rows.size()));
    for (CostRow& row : chunk->rows) result.rows.push_back(row);
    EXPECT_EQ(chunk->rows_done, static_cast<int64_t>(result.rows.size()));
    EXPECT_EQ(chunk->summary.has_value(), chunk->rows_done == chunk->rows_total);
    if (chunk->summary.has_value()) result.summary = *chunk->summary;
  }
  return result;
}

// One sample makes a test short; the limit leaves time for it on a slow machine.
Study StudyOf(const Scene& scene) { return StudyOf({.scene = scene, .time_limit_s = 30.0, .samples = 1}); }

// Lubarda (2009), sec. 4: x = mu |b|/a = 1/3, so that kappa_hat = sqrt((1 - x)/(1 + x)) = sqrt(1/2). V = |b omega-| =
// 1.
Scene PaperScene() {
  return {.system = Pendulum{.inertia_kg_m2 = 1.0, .a_m = 0.3, .b_m = 1.0, .omega_minus_rad_s = -1.0},
          .friction = {.kinetic_coefficient = 0.1},
          .restitution = EnergeticCoefficient{1.0}};
}

Scene SpringAndMoment() {
  Scene scene = PaperScene();
  scene.compliance = Compliance{.tangential_ratio_squared = std::nullopt, .normal = LinearSpring{1e5}};
  scene.finite_forces = PinMoment{-2.0};
  return scene;
}

// Scenes of every kind: each system, rigid and compliant, in time, locked, separating and under a law.
std::vector<Scene> ScenesOfEveryKind() {
  std::vector<Scene> scenes = {PaperScene(), SpringAndMoment()};
  for (const System& system : Systems()) scenes.push_back(With(system));
  Scene locked = PaperScene();
  locked.friction.kinetic_coefficient = 0.5;
  scenes.push_back(locked);
  Scene separating = PaperScene();
  std::get<Pendulum>(separating.system).omega_minus_rad_s = 1.0;
  scenes.push_back(separating);
  Scene separating_in_space = With(ContactInSpace());
  std::get<SpatialContact>(separating_in_space.system).normal_m_s = 0.4;
  scenes.push_back(separating_in_space);
  Scene compliant = With(Contact());
  compliant.compliance = Compliance{.tangential_ratio_squared = 1.2, .normal = {}};
  scenes.push_back(compliant);
  Scene damped = With(Flat());
  damped.restitution = std::monostate();
  damped.compliance =
      Compliance{.tangential_ratio_squared = std::nullopt,
                 .normal = HuntCrossleySpring{.stiffness_n_m_p = 1e6, .exponent = 1.5, .damping_s_m = 0.2}};
  scenes.push_back(damped);
  Scene law = With(Flat());
  law.restitution = std::monostate();
  law.impact_law = WhittakerLaw{0.5};
  scenes.push_back(law);
  return scenes;
}

struct SceneStudy {
  Scene scene;
  Study study;
};

// Each scene is studied once for all tests.
const std::vector<SceneStudy>& StudiesOfEveryKind() {
  static const std::vector<SceneStudy> studies = [] {
    std::vector<SceneStudy> all;
    for (const Scene& scene : ScenesOfEveryKind()) all.push_back({scene, StudyOf(scene)});
    return all;
  }();
  return studies;
}

TEST(CostTest, APendulumHasEveryMethod) {
  const Study study = StudyOf(PaperScene());
  EXPECT_THAT(study.Names(),
              IsSupersetOf({"frictionless", "first order", "closed form, plain", "closed form, compensated",
                            "planar, plain", "planar, compensated", "certified, 16 digits", "certified, 32 digits",
                            "certified, 64 digits", "duration k=1e+08 0.001", "duration k=1e+08 1e-12"}));
  EXPECT_TRUE(study["closed form, plain"].batch_in_lanes);
  EXPECT_FALSE(study["planar, plain"].batch_in_lanes);
}

TEST(CostTest, SpaceHasElevenTolerances) {
  const Study study = StudyOf(With(ContactInSpace()));
  int tolerances = 0;
  for (const CostRow& row : study.rows) tolerances += row.method.model == Model::kSpatial ? 1 : 0;
  EXPECT_EQ(tolerances, 11);
  EXPECT_THAT(study.Names(), IsSupersetOf({"sliding", "space 0.01", "space 1e-12"}));
  EXPECT_GT(study["space 1e-12"].right_hand_sides, study["space 0.01"].right_hand_sides);
}

TEST(CostTest, ErrorsOfModelsAreThoseOfThePaper) {
  const Study study = StudyOf(PaperScene());
  const CostError frictionless = *study["frictionless"].achieved;
  EXPECT_NEAR(frictionless.modelling, 1.0 - std::sqrt(0.5), 1e-15);  // kappa_hat = eta without friction.
  EXPECT_NEAR(frictionless.total, 1.0 - std::sqrt(0.5), 1e-15);
  EXPECT_LE(frictionless.numerical, 1e-15);
  const CostError first_order = *study["first order"].achieved;
  EXPECT_NEAR(first_order.modelling, std::sqrt(0.5) - 2.0 / 3.0, 1e-15);  // kappa_hat = 1 - x, [58]
  EXPECT_LE(first_order.numerical, 1e-15);
  EXPECT_EQ(study["closed form, plain"].achieved->modelling, 0.0);
  EXPECT_LE(study["closed form, compensated"].achieved->total, 0x1p-53);
}

TEST(CostTest, TakesAsManySamplesAsAskedAndOrdersTheirQuartiles) {
  const Study study = StudyOf({.scene = With(ContactInSpace()), .samples = 9});
  const CostTime time = *study["sliding"].solve;
  EXPECT_EQ(time.samples, 9);
  EXPECT_LE(time.lower_quartile_s, time.median_s);
  EXPECT_LE(time.median_s, time.upper_quartile_s);
}

TEST(CostTest, CertifiedDigitsAreWithinAUnitOfTheLastAndNotMuchBelow) {
  if (!certified::IsAvailable()) GTEST_SKIP() << "the component certified is left out";
  const Study study = StudyOf(PaperScene());
  for (const int digits : {16, 32, 64}) {
    const CostRow& row = study["certified, " + std::to_string(digits) + " digits"];
    EXPECT_LE(row.achieved->total, std::pow(10.0, -digits)) << digits;
    EXPECT_GE(row.achieved->total, std::pow(10.0, -digits - 3)) << digits;  // sqrt(1/2) is irrational.
  }
}

TEST(CostTest, AStraightPathIsTheWholeImpactWhereSlipNeverStops) {
  const Study study = StudyOf(With(Flat()));
  EXPECT_LE(study["sliding"].achieved->modelling, 1e-28);
  EXPECT_LE(study["sliding"].achieved->numerical, study["sliding"].claimed.numerical);
}

TEST(CostTest, AStiffnessThatChangesNoImpulseIsTriedOnce) {
  const auto springs = [](const Scene& scene) {
    std::set<double> tried;
    for (const CostRow& row : StudyOf(scene).rows) {
      if (row.method.model == Model::kFiniteDuration) tried.insert(row.method.stiffness);
    }
    return tried.size();
  };
  EXPECT_EQ(springs(PaperScene()), 1U);
  EXPECT_EQ(springs(SpringAndMoment()), 3U);
}

TEST(CostTest, ASpringGivesFiniteForcesTimeAndAStifferOneLess) {
  const Study study = StudyOf(SpringAndMoment());
  const double soft = study["duration k=1000 1e-09"].achieved->modelling;
  const double rigid = study["closed form, compensated"].achieved->modelling;
  const double stiff = study["duration k=1e+07 1e-09"].achieved->modelling;
  EXPECT_EQ(study["duration k=100000 1e-09"].achieved->modelling, 0.0);
  // Contact takes a time T of order 1/sqrt(k), so that each spring is further from the scene's by its own T minus the
  // scene's: 9, 1 - 1/10 and 1 in units of the scene's T.
  EXPECT_NEAR(stiff / rigid, 0.9, 0.02);
  EXPECT_NEAR(soft / rigid, 9.0, 4.0);
}

TEST(CostTest, NoClaimDeceives) {
  for (const auto& [scene, study] : StudiesOfEveryKind()) {
    EXPECT_EQ(study.summary.deceived, 0);
    for (const CostRow& row : study.rows) {
      EXPECT_FALSE(row.ClaimIsBroken()) << row.name;
      if (!row.achieved.has_value()) continue;
      EXPECT_LE(row.achieved->numerical, row.claimed.numerical + row.reference_error) << row.name;
      EXPECT_LE(row.achieved->modelling, row.claimed.modelling + row.reference_error) << row.name;
      EXPECT_LE(row.achieved->total, (row.achieved->numerical + row.achieved->modelling) * (1.0 + 1e-12)) << row.name;
    }
  }
}

TEST(CostTest, EveryRowHasATimeOrSaysWhyNot) {
  for (const auto& [scene, study] : StudiesOfEveryKind()) {
    std::set<std::string> names;
    EXPECT_FALSE(study.rows.empty());
    for (const CostRow& row : study.rows) {
      EXPECT_TRUE(names.insert(row.name).second) << row.name << " occurs twice";
      EXPECT_LE(row.name.size(), 32U) << row.name;
      EXPECT_TRUE(row.status == CostStatus::kMeasured || !row.note.empty()) << row.name;
      EXPECT_TRUE(row.achieved.has_value() || !row.note.empty()) << row.name;
      EXPECT_TRUE(row.batch.has_value() || !row.note.empty()) << row.name;
      if (row.status != CostStatus::kMeasured) continue;
      ASSERT_TRUE(row.solve.has_value()) << row.name;
      EXPECT_GT(row.solve->median_s, 0.0) << row.name;
      EXPECT_EQ(row.solve->samples, 1) << row.name;
      EXPECT_EQ(row.batch.value_or(CostTime{.per_sample = kCostBatch}).per_sample, kCostBatch) << row.name;
    }
  }
}

TEST(CostTest, PicksAreThePlansOfAnswersAtEachTolerance) {
  for (const auto& [scene, study] : StudiesOfEveryKind()) {
    for (const double tolerance : kCostTolerances) {
      const auto pick = std::find_if(study.summary.picks.begin(), study.summary.picks.end(), [&](const CostPick& one) {
        return one.least_tolerance <= tolerance && tolerance <= one.most_tolerance;
      });
      ASSERT_NE(pick, study.summary.picks.end()) << tolerance;
      const auto answer = LocalSolver().Solve({.scene = scene, .demand = {.relative_tolerance = tolerance}});
      ASSERT_TRUE(answer.ok()) << answer.status();
      const Plan& plan = answer->outcome.plan;
      EXPECT_EQ(pick->model, plan.model) << tolerance;
      if (plan.model == Model::kNone) continue;
      ASSERT_GE(pick->row, 0) << tolerance;
      const CostMethod& method = study.rows[static_cast<size_t>(pick->row)].method;
      EXPECT_EQ(method.model, plan.model) << tolerance;
      EXPECT_EQ(method.arithmetic, plan.arithmetic.arithmetic) << tolerance;
      EXPECT_LE(method.tolerance.value_or(0.0), std::max(tolerance, 1e-12) * (1.0 + 1e-9));
    }
  }
}

TEST(CostTest, ThePlanPicksCompensatedArithmeticAtZeroAndPlainFarAbove) {
  const Study study = StudyOf(PaperScene());
  ASSERT_GE(study.summary.picks.size(), 2U);
  EXPECT_EQ(study.rows[static_cast<size_t>(study.summary.picks[0].row)].name, "closed form, compensated");
  EXPECT_EQ(study.summary.picks[0].least_tolerance, 0.0);
  EXPECT_EQ(study.rows[static_cast<size_t>(study.summary.picks[1].row)].name, "closed form, plain");
}

TEST(CostTest, AMethodWithoutTimeStaysInTheReportAndSaysSo) {
  Scene scene = PaperScene();
  scene.restitution = std::monostate();
  scene.compliance = Compliance{.tangential_ratio_squared = std::nullopt, .normal = HuntCrossleySpring{1e5, 2.2, 0.1}};
  const Study study = StudyOf({.scene = scene, .time_limit_s = kLeastCostTimeLimitS});
  EXPECT_EQ(study.rows.size(), StudyOf(scene).rows.size());
  EXPECT_GT(study.summary.out_of_time, 0);
  EXPECT_LT(study.summary.elapsed_s, 10.0);
  EXPECT_THAT(study.rows, Contains(AllOf(Field(&CostRow::status, CostStatus::kOutOfTime),
                                         Field(&CostRow::note, HasSubstr("time limit")))));
}

TEST(CostTest, AnImpactLawClaimsWhatItsOutcomeStates) {
  Scene scene = {.system = PlanarContact{2.0, 0.5, 1.0, 1.0, -1.0}, .friction = {.kinetic_coefficient = 0.5}};
  scene.impact_law = ChatterjeeRuinaLaw{0.0, -1.0};
  const auto solved = LocalSolver().Solve({.scene = scene});
  ASSERT_TRUE(solved.ok()) << solved.status();
  EXPECT_EQ(StudyOf(scene).rows[0].claimed.total, solved->outcome.accuracy.relative_error);
}

TEST(CostTest, AMethodThatCannotProveItsAnswerFailsInWords) {
  const Study study = StudyOf(With(Contact()));  // u and v reach 0 at the same time.
  const CostRow& plain = study["planar, plain"];
  EXPECT_EQ(plain.status, CostStatus::kFailed);
  EXPECT_THAT(plain.note, HasSubstr("cannot prove"));
  EXPECT_TRUE(plain.solve.has_value());
  EXPECT_FALSE(plain.achieved.has_value());
  EXPECT_EQ(plain.claimed.total, std::numeric_limits<double>::infinity());
  EXPECT_EQ(study.summary.failed, 1);
}

TEST(CostTest, EveryViolationIsReportedAtOnce) {
  Scene scene = PaperScene();
  scene.friction.kinetic_coefficient = -0.1;
  const absl::Status status = CostStudy::Make({.scene = scene, .time_limit_s = 61.0, .samples = 0}).status();
  EXPECT_THAT(ViolationsOf(status), ElementsAre(Violation{"friction.kinetic_coefficient", "= -0.1: must be >= 0"},
                                                Violation{"time_limit_s", "= 61: must be in [0.01, 60]"},
                                                Violation{"samples", "= 0: must be in [1, 1001]"}));
  EXPECT_FALSE(CostStudy::Make({.scene = PaperScene(), .time_limit_s = std::nan("")}).ok());
}

// Two contacts of three equal balls have W = (2, -1; -1, 2) and start at (-1, 0). By energy and v >= 0 each of their
// velocities after lies in [0, 1]; an elastic cradle ends at (0, 1).
TEST(CostTest, SeveralContactsHaveTheirOwnMethods) {
  const Study study =
      StudyOf({.time_limit_s = 30.0, .samples = 1, .multi_contact = RowOfBalls({1, 1, 1}, {1, 0, 0}, {1.0, 1.0})});
  EXPECT_THAT(study.Names(), ElementsAre("orders", "springs", "possible"));
  for (const CostRow& row : study.rows) {
    EXPECT_EQ(row.status, CostStatus::kMeasured) << row.name;
    EXPECT_GT(row.solve->median_s, 0.0) << row.name;
    EXPECT_FALSE(row.achieved.has_value()) << row.name;
  }
  EXPECT_EQ(study["springs"].method.multi_contact, MultiContactMethod::kSprings);
  EXPECT_GE(study["possible"].claimed.total, 1.0);
  EXPECT_LE(study["possible"].claimed.total, 1.0 + 1e-9);
  EXPECT_LE(study["orders"].claimed.numerical, 1e-14);
  EXPECT_EQ(study["orders"].claimed.total, std::numeric_limits<double>::infinity());
  EXPECT_THAT(study["orders"].note, HasSubstr("one outcome"));
  EXPECT_EQ(study.summary.picks.size(), 0U);
  EXPECT_EQ(study.summary.front.size(), 0U);
}

// Each foot that strikes first leaves at 0.5 m/s and the other at 0.05 m/s, because the block turns at 0.45 rad/s.
TEST(CostTest, OrdersSayHowFarTheirOutcomesLieApart) {
  const Study study =
      StudyOf({.time_limit_s = 30.0, .samples = 1, .multi_contact = FallingBlock(/*friction=*/1.0, /*energetic=*/0.5)});
  EXPECT_THAT(study["orders"].note, HasSubstr("2 outcomes up to 0.45 apart"));
}

TEST(CostTest, SpaceHasNoSprings) {
  const Study study = StudyOf({.time_limit_s = 30.0, .samples = 1, .multi_contact = SpatialBox()});
  EXPECT_THAT(study.Names(), ElementsAre("orders", "possible"));
}

TEST(CostTest, ASceneBesideSeveralContactsIsRefused) {
  CostRequest request = {.scene = PaperScene(), .multi_contact = FallingBlock(1.0, 0.5)};
  request.multi_contact->contacts[0].friction = -1.0;
  EXPECT_THAT(ViolationsOf(CostStudy::Make(request).status()),
              ElementsAre(Violation{"contacts[0].friction", "= -1: must be >= 0"},
                          Violation{"scene", "is set: must be left out beside multi_contact"}));
}

TEST(CostTest, AStopEndsTheStudy) {
  absl::StatusOr<CostStudy> study = CostStudy::Make({.scene = SpringAndMoment()});
  ASSERT_TRUE(study->NextChunk(Never).ok());
  int64_t asked = 0;
  const auto chunk = study->NextChunk([&asked] { return ++asked > 3; });
  EXPECT_EQ(chunk.status().code(), absl::StatusCode::kCancelled);
  EXPECT_LE(asked, 8);
}

TEST(CostTest, NamesTheMachine) {
  const CostMachine machine = StudyOf(PaperScene()).summary.machine;
  EXPECT_FALSE(machine.cpu.empty());
  EXPECT_THAT(machine.compiler, Not(HasSubstr("unknown")));
  EXPECT_FALSE(machine.simd_target.empty());
}

CostRow MadeRow(double seconds, double error) {
  return {
      .status = CostStatus::kMeasured, .solve = CostTime{.median_s = seconds}, .achieved = CostError{.total = error}};
}

TEST(ParetoFrontTest, KeepsTheRowsThatNoOtherBeats) {
  std::vector<CostRow> rows = {MadeRow(3.0, 0.1), MadeRow(1.0, 0.5), MadeRow(2.0, 0.6), MadeRow(4.0, 0.05),
                               MadeRow(1.0, 0.4)};
  EXPECT_THAT(ParetoFront(rows), ElementsAre(4, 0, 3));
  rows[4].achieved.reset();
  EXPECT_THAT(ParetoFront(rows), ElementsAre(1, 0, 3));
  rows[0].status = CostStatus::kFailed;
  EXPECT_THAT(ParetoFront(rows), ElementsAre(1, 3));
}

TEST(ParetoFrontTest, AnErrorCountsAsNoSmallerThanItsReferenceTells) {
  std::vector<CostRow> rows = {MadeRow(1.0, 1e-12), MadeRow(2.0, 0.0)};
  rows[1].reference_error = 1e-11;
  EXPECT_THAT(ParetoFront(rows), ElementsAre(0));
}

// The velocities of a batch differ, and none may leave the range of doubles: a certified answer takes finite numbers
// only.
TEST(CostTest, ABatchOfTheFastestImpactStaysWithinDoubles) {
  constexpr double kFastest = -std::numeric_limits<double>::max();
  for (const System& system :
       {System(Pendulum{.inertia_kg_m2 = 1.0, .a_m = 0.3, .b_m = 1.0, .omega_minus_rad_s = kFastest}),
        System(PlanarContact{1.0, 0.0, 1.0, 0.0, kFastest})}) {
    Methods methods;
    AddCertified({.system = system, .restitution = EnergeticCoefficient{0.5}}, 1.0, 0.0, nullptr, methods);
    for (const StudiedMethod& method : methods) {
      if (method.kernel.make_batch == nullptr) continue;  // This build has no certified answers.
      method.kernel.make_batch()(kCostBatch - 2, 2, Never);
    }
    EXPECT_EQ(methods.size(), 3U);
  }
}

}  // namespace
}  // namespace ricochet
