// Columns: every number of every system is the field of Solve's outcome, and unset where that is unset; asking for a
// number is asking for the effects that make it; a number that no outcome of the scene can have is refused.

#include "core/rows/column.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <map>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "absl/strings/str_cat.h"
#include "core/scene/field.h"
#include "core/scene/numbers.h"
#include "ricochet/outcome_numbers.h"
#include "ricochet/solver.h"
#include "tests/support/scenes/batch_table.h"
#include "tests/support/scenes/drivable_numbers.h"
#include "tests/support/scenes/random_scenes.h"
#include "tests/support/scenes/system_scenes.h"

namespace ricochet {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::Field;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::IsSupersetOf;
using testing::Not;
using testing::StartsWith;

// The answer of Solve for one scene.
struct Answer {
  absl::StatusCode code = absl::StatusCode::kOk;
  Regime regime = Regime::kInvalid;
  bool admissible = true;
  Termination termination = Termination::kConverged;
  std::map<std::string, double> numbers;  // The numbers that are set.
};

Answer AnswerOf(const Scene& scene, DemandFields demand, bool takes_time) {
  if (takes_time) demand.required.push_back(Effect::kFiniteDuration);
  const auto response =
      LocalSolver().Solve({.scene = scene, .demand = demand, .both_ends = HoldsCoordinates(scene.system)});
  if (!response.ok()) return {.code = response.status().code(), .numbers = {}};
  const Outcome& outcome = response->outcome;
  Answer answer = {
      .regime = outcome.regime, .admissible = outcome.admissible, .termination = outcome.termination, .numbers = {}};
  VisitOutcomeNumbers(outcome,
                      [&](const NumberPath& path, double number) { answer.numbers.emplace(path.Text(), number); });
  return answer;
}

// Scenes of one kind, as rows: the numbers of each that can be driven, by their paths.
BatchTable TableOf(const std::vector<Scene>& scenes, const DemandFields& demand) {
  BatchTable table;
  table.setup.scene = scenes.front();
  table.setup.demand = demand;
  for (const Scene& scene : scenes) {
    std::vector<double> row;
    table.setup.fields.clear();
    VisitDrivableNumbers(scene, [&](std::string path, double number) {
      table.setup.fields.push_back(std::move(path));
      row.push_back(number);
    });
    table.Add(row);
  }
  return table;
}

RowStatus StatusOf(const Answer& answer, const std::vector<std::string>& columns) {
  if (answer.code == absl::StatusCode::kInvalidArgument) return RowStatus::kInvalid;
  if (!answer.admissible) return RowStatus::kInadmissible;
  if (answer.termination != Termination::kConverged) return RowStatus::kNotConverged;
  const bool is_complete = std::all_of(columns.begin(), columns.end(),
                                       [&](const std::string& column) { return answer.numbers.contains(column); });
  return is_complete ? RowStatus::kOk : RowStatus::kIncomplete;
}

// Counts what has been compared, so that no test passes for want of numbers.
struct Compared {
  int64_t set = 0, unset = 0, invalid = 0;
};

// Expects that the rows of a table, which was solved, are the answers. The numbers of `asked` are those of its columns.
void ExpectAnswers(const BatchTable& table, const std::vector<Answer>& answers, Compared& compared) {
  for (size_t i = 0; i < table.size(); ++i) {
    const Answer& answer = answers[i];
    if (answer.code == absl::StatusCode::kOutOfRange) continue;  // The number that is too large may be no column.
    ASSERT_EQ(table.statuses[i], StatusOf(answer, table.setup.columns)) << "row " << i;
    ASSERT_EQ(table.regimes[i], answer.regime) << "row " << i;
    compared.invalid += answer.code == absl::StatusCode::kOk ? 0 : 1;
    for (size_t c = 0; c < table.out.size(); ++c) {
      const std::string& column = table.setup.columns[c];
      const auto found = answer.numbers.find(column);
      if (found == answer.numbers.end()) {
        ASSERT_TRUE(std::isnan(table.out[c][i])) << column << " of row " << i << " = " << table.out[c][i];
        ++compared.unset;
        continue;
      }
      ASSERT_EQ(std::bit_cast<uint64_t>(table.out[c][i]), std::bit_cast<uint64_t>(found->second))
          << column << " of row " << i << ": " << table.out[c][i] << " and " << found->second;
      ++compared.set;
    }
  }
}

// Solves the table as a batch and as a sweep, and compares both with the answers of Solve.
void CompareRows(BatchTable table, const std::vector<std::string>& columns, const std::vector<Answer>& answers,
                 Compared& compared) {
  table.setup.columns = columns;
  const auto solved = table.Solve();
  ASSERT_TRUE(solved.ok()) << solved.status();
  ExpectAnswers(table, answers, compared);
  ExpectBitsOfTheRowsInASweep(table);
}

class ColumnsOfEverySystem : public testing::TestWithParam<size_t> {};

INSTANTIATE_TEST_SUITE_P(Systems, ColumnsOfEverySystem, testing::Range(size_t{0}, RandomSystems().size()),
                         [](const auto& parameter) { return RandomSystems()[parameter.param].name; });

TEST_P(ColumnsOfEverySystem, AreThoseOfSolveInEverySweepAndBatchAndUnsetWhereTheseAreUnset) {
  constexpr size_t kScenes = 200;
  constexpr size_t kFewScenes = 10;  // For the columns one by one, where each answer is integrated.
  const RandomSystem system = RandomSystems()[GetParam()];
  RandomScenes random(2026 + GetParam());
  Compared compared;
  int64_t timed = 0;
  const std::vector<std::optional<double>> tolerances = {std::nullopt, 0.0, 1e-3};
  size_t turn = 0;
  for (const SceneKind& kind : SceneKinds(system)) {
    SCOPED_TRACE(kind.name);
    DemandFields demand;
    demand.relative_tolerance = tolerances[turn++ % tolerances.size()];
    std::vector<Scene> scenes;
    for (size_t i = 0; i < kScenes; ++i) scenes.push_back(kind.make(random));
    const std::vector<std::string> all = Columns(scenes.front());
    std::vector<std::string> rigid;
    std::copy_if(all.begin(), all.end(), std::back_inserter(rigid),
                 [](const std::string& column) { return column.rfind("contact.", 0) != 0; });
    const bool may_take_time = rigid.size() < all.size();
    std::vector<Answer> answers, timed_answers;
    for (const Scene& scene : scenes) {
      answers.push_back(AnswerOf(scene, demand, false));
      if (may_take_time) timed_answers.push_back(AnswerOf(scene, demand, true));
    }
    const BatchTable table = TableOf(scenes, demand);
    CompareRows(table, rigid, answers, compared);
    if (may_take_time) CompareRows(table, all, timed_answers, compared);
    scenes.resize(kind.takes_time || may_take_time ? kFewScenes : kScenes);
    const BatchTable alone = TableOf(scenes, demand);
    for (const std::string& column : all) {
      const bool takes_time = column.rfind("contact.", 0) == 0;
      CompareRows(alone, {column}, takes_time ? timed_answers : answers, compared);
      timed += takes_time ? 1 : 0;
      if (HasFatalFailure()) return;
    }
  }
  EXPECT_GT(compared.set, 50'000);
  EXPECT_LT(compared.invalid, compared.set / 100);
  EXPECT_EQ(timed > 0, !system.in_space);
}

struct Rows {
  absl::Status status;
  std::vector<double> values;  // The first column has them.
  std::vector<RowStatus> statuses;
};

Rows SweepOf(SweepRequest request) {
  request.with_regime = true;
  Rows rows;
  for (const absl::StatusOr<SweepChunk>& chunk : LocalSolver().Sweep(request)) {
    rows.status = chunk.status();
    if (!chunk.ok()) break;
    rows.values.insert(rows.values.end(), chunk->values.begin(), chunk->values.begin() + chunk->count);
    rows.statuses.insert(rows.statuses.end(), chunk->statuses.begin(), chunk->statuses.end());
  }
  return rows;
}

// A body without spin strikes above its middle, on a spring: the impact lasts half a period, sqrt(m/k) pi.
Scene OnALinearSpring() {
  return {.system = PlanarBody{.mass_kg = 2.0, .inertia_com_kg_m2 = 0.1, .offset_n_m = -0.1, .velocity_n_m_s = -3.0},
          .restitution = EnergeticCoefficient{1.0},
          .compliance = Compliance{.tangential_ratio_squared = {}, .normal = LinearSpring{2e4}}};
}

TEST(ColumnTest, ADurationThatIsAskedForIsComputed) {
  const Axis velocity = {"planar_body.velocity_n_m_s", ListValues{{-3.0, -6.0}}};
  const Rows durations =
      SweepOf({.grid = {.scene = OnALinearSpring(), .axes = {velocity}}, .columns = {"contact.duration_s"}});
  const Rows peaks =
      SweepOf({.grid = {.scene = OnALinearSpring(), .axes = {velocity}}, .columns = {"contact.peak_normal_n"}});
  for (size_t i = 0; i < 2; ++i) {
    EXPECT_NEAR(durations.values[i], std::numbers::pi * std::sqrt(2.0 / 2e4), 1e-12);
    EXPECT_NEAR(peaks.values[i], 3.0 * static_cast<double>(i + 1) * std::sqrt(2.0 * 2e4), 1e-8);
    EXPECT_EQ(durations.statuses[i], RowStatus::kOk);
  }
}

// At the limit of sticking there is no derivative. The impact returns more than it took all the same.
TEST(ColumnTest, ARowWithoutADerivativeIsStillInadmissible) {
  const std::string newton = "coefficients.newton", mu = "friction.kinetic_coefficient";
  const Axis friction = {mu, ListValues{{0.0, 0.1}}};
  const Scene scene = {.system = Pendulum{1.0, 0.3, 1.0, -1.0}, .restitution = NewtonCoefficient{1.2}};
  for (const bool with_derivative : {false, true}) {
    std::vector<std::string> columns = {newton};
    if (with_derivative) columns.push_back(absl::StrCat("d(", newton, ")/d(", mu, ")"));
    const Rows rows = SweepOf({.grid = {.scene = scene, .axes = {friction}}, .columns = columns});
    EXPECT_THAT(rows.statuses, ElementsAre(RowStatus::kInadmissible, RowStatus::kInadmissible)) << with_derivative;
  }
}

// The end without held coordinates breaks a limit where friction is large, the one with the held coordinate never.
TEST(ColumnTest, AFreeEndThatIsAskedForIsJudged) {
  const Mechanism arm = {.mass_matrix = {2.0, 0.0, 0.0, 0.0, 2.0, 0.0, 0.0, 0.0, 0.1},
                         .jacobian = {1.0, 0.0, 3.0, 0.0, 1.0, -3.0},
                         .rates = {1.0, -1.0, 0.0},
                         .kept_coordinates = {2}};
  const Scene scene = {.system = arm, .restitution = NewtonCoefficient{0.9}};
  const Axis friction = {"friction.kinetic_coefficient", ListValues{{0.1, 1.9}}};
  const auto statuses_of = [&](const std::string& column) {
    return SweepOf({.grid = {.scene = scene, .axes = {friction}}, .columns = {column}}).statuses;
  };
  std::vector<RowStatus> expected;
  for (const double mu : {0.1, 1.9}) {
    Scene free = scene;
    free.friction.kinetic_coefficient = mu;
    std::get<Mechanism>(free.system).kept_coordinates.clear();
    const bool admissible = LocalSolver().Solve({.scene = free})->outcome.admissible;
    expected.push_back(admissible ? RowStatus::kOk : RowStatus::kInadmissible);
  }
  EXPECT_EQ(expected.back(), RowStatus::kInadmissible);
  EXPECT_THAT(statuses_of("coefficients.newton"), ElementsAre(RowStatus::kOk, RowStatus::kOk));
  EXPECT_EQ(statuses_of("free_end.coefficients.newton"), expected);
}

TEST(ColumnTest, AContactThatSeparatesHasNoDurationAndItsRowSaysSo) {
  const Axis velocity = {"planar_body.velocity_n_m_s", ListValues{{-3.0, 3.0}}};
  const Rows alone =
      SweepOf({.grid = {.scene = OnALinearSpring(), .axes = {velocity}}, .columns = {"contact.peak_normal_n"}});
  EXPECT_THAT(alone.statuses, ElementsAre(RowStatus::kOk, RowStatus::kIncomplete));
  EXPECT_TRUE(std::isnan(alone.values[1]));
  const Rows beside = SweepOf({.grid = {.scene = OnALinearSpring(), .axes = {velocity}},
                               .columns = {"contact_velocity_after.normal_m_s", "contact.peak_normal_n"}});
  EXPECT_THAT(beside.statuses, ElementsAre(RowStatus::kOk, RowStatus::kIncomplete));
  EXPECT_EQ(beside.values[1], 3.0);
}

std::string Refusal(const Scene& scene, const std::string& column, const DemandFields& demand = {}) {
  const Rows rows = SweepOf({.grid = {.scene = scene}, .columns = {column}, .demand = demand});
  const auto batch = LocalSolver().OpenBatches(
      {.scene = scene, .fields = {"friction.kinetic_coefficient"}, .columns = {column}, .demand = demand});
  EXPECT_EQ(rows.status.code(), absl::StatusCode::kInvalidArgument) << column;
  EXPECT_EQ(rows.status.message(), batch.status().message());
  return std::string(rows.status.message());
}

TEST(ColumnTest, ANumberThatNoOutcomeOfTheSceneHasIsRefusedWithWhatWouldMakeIt) {
  EXPECT_THAT(Refusal(With(Flat()), "contact.duration_s"),
              HasSubstr("columns[0] = \"contact.duration_s\": must not be asked of a scene without a normal spring in "
                        "compliance"));
  Scene law = With(Contact());
  law.restitution = std::monostate();
  law.impact_law = WhittakerLaw{0.5};
  for (const char* column :
       {"coefficients.poisson", "work.normal_restitution_j", "errors.energetic", "errors.normal_m_s"}) {
    EXPECT_THAT(Refusal(law, column),
                HasSubstr("must be a column of the scene; an impact law has no phases of compression and restitution"));
  }
  EXPECT_THAT(Refusal(law, "contact.duration_s"), HasSubstr("a scene without a normal spring"));
  EXPECT_THAT(Refusal(With(Flat()), "rates_after_rad_s[0]"),
              HasSubstr("must be a column of the scene; rates_after_rad_s has an entry for each link"));
  EXPECT_THAT(Refusal(With(Chain()), "rates_after_rad_s[2]"), HasSubstr("an entry for each link of a linkage"));
  EXPECT_THAT(Refusal(With(Contact()), "bodies_after[0].linear_m_s[0]"), HasSubstr("bodies_after has an entry for"));
  EXPECT_THAT(Refusal(With(Contact()), "impulse.tangential_n_s[1]"), HasSubstr("only a system in space has two"));
  Scene damped = OnALinearSpring();
  damped.restitution = std::monostate();
  damped.compliance->normal = HuntCrossleySpring{1e6, 1.5, 0.1};
  EXPECT_THAT(Refusal(damped, "effective.restitution"), HasSubstr("the damping of compliance.hunt_crossley"));
  EXPECT_THAT(Refusal(With(Flat()), "coefficients.neuton"), HasSubstr("did you mean coefficients.newton?"));
}

TEST(ColumnTest, ADurationIsNotAskedForBesidesWhatLeavesItOut) {
  EXPECT_THAT(Refusal(OnALinearSpring(), "contact.duration_s", {.excluded = {Effect::kFiniteDuration}}),
              HasSubstr("columns[0] = \"contact.duration_s\": needs finite_duration, which must not be excluded too"));
  Scene rubbing = OnALinearSpring();
  rubbing.friction.kinetic_coefficient = 0.1;
  EXPECT_THAT(Refusal(rubbing, "contact.duration_s", {.excluded = {Effect::kSlipStop}}),
              HasSubstr("needs finite_duration, and excluded[0] = slip_stop: must be left in: the model of finite "
                        "duration has slip that stops; exclude friction"));
}

TEST(ColumnTest, ColumnsAreTheNumbersThatAnOutcomeOfTheSceneMayHave) {
  EXPECT_THAT(Columns(With(Flat())), Not(Contains(StartsWith("contact."))));
  EXPECT_THAT(Columns(OnALinearSpring()), IsSupersetOf({"contact.duration_s", "errors.newton", "errors.normal_m_s"}));
  EXPECT_THAT(ColumnPlaces(With(Flat())), Contains("contact.duration_s"));
  EXPECT_TRUE(MayBeUnset("errors.newton"));
  EXPECT_TRUE(MayBeUnset("contact.duration_s"));
  EXPECT_FALSE(MayBeUnset("contact_velocity_after.normal_m_s"));
}

TEST(ColumnTest, AnErrorMayBeInfiniteAndNoOtherNumberMay) {
  Outcome outcome;
  outcome.contact_velocity_after.tangential_m_s = outcome.impulse.tangential_n_s = {0.0};
  const double infinity = std::numeric_limits<double>::infinity();
  outcome.accuracy.relative_error = infinity;
  outcome.errors.newton = infinity;
  outcome.impulse.normal_total_n_s = infinity;
  const auto read = [&](const std::vector<std::string>& columns, std::vector<double>& numbers) {
    return ColumnReader(With(Contact()), columns).Read(outcome, numbers);
  };
  std::vector<double> numbers;
  EXPECT_EQ(read({"errors.newton", "accuracy.relative_error"}, numbers).status, RowStatus::kOk);
  EXPECT_THAT(numbers, ElementsAre(infinity, infinity));
  EXPECT_EQ(read({"errors.newton", "errors.poisson"}, numbers).status, RowStatus::kIncomplete);
  EXPECT_TRUE(std::isnan(numbers[1]));
  const auto too_large = read({"errors.poisson", "impulse.normal_total_n_s"}, numbers);
  EXPECT_EQ(too_large.status, RowStatus::kNotRepresentable);
  EXPECT_EQ(too_large.too_large, 1U);
  outcome.termination = Termination::kLessAccurate;
  EXPECT_EQ(read({"errors.poisson"}, numbers).status, RowStatus::kNotConverged);
  outcome.admissible = false;
  EXPECT_EQ(read({"errors.poisson"}, numbers).status, RowStatus::kInadmissible);
}

// --- Notes ---

std::vector<Note> NotesOf(const Scene& scene, const DemandFields& demand = {}) {
  const auto response =
      LocalSolver().Solve({.scene = scene, .demand = demand, .both_ends = HoldsCoordinates(scene.system)});
  EXPECT_TRUE(response.ok()) << response.status();
  return response->outcome.notes;
}

// If the whole impact refutes the verdict of a coarse plan, that verdict must have had the note.
TEST(VerdictNoteTest, StandsWhereverAnAdmissibleOutcomeIsNone) {
  RandomScenes random(5);
  const auto solve = [](const Scene& scene, double tolerance) {
    return LocalSolver().Solve({.scene = scene, .demand = {.relative_tolerance = tolerance}});
  };
  int turned = 0;
  for (int i = 0; i < 20'000; ++i) {
    const double tt = random.Power(-0.5, 0.5), nn = random.Power(-0.5, 0.5);
    const double tn = random.Uniform(-0.9, 0.9) * std::sqrt(tt * nn);
    const Scene scene = {.system = PlanarContact{tt, tn, nn, random.Uniform(-2.0, 2.0), -random.Power(-1.0, 0.5)},
                         .friction = {.kinetic_coefficient = random.Power(-3.0, -1.0)},
                         .restitution = NewtonCoefficient{random.Uniform(0.8, 1.05)}};
    const auto whole = solve(scene, 0.0), coarse = solve(scene, 0.1);
    if (whole->outcome.admissible || !coarse->outcome.admissible) continue;
    ++turned;
    EXPECT_THAT(coarse->outcome.notes, Contains(Field(&Note::path, "admissible"))) << i;
  }
  EXPECT_GT(turned, 20);
}

// Without friction the energetic coefficient is 1; with it, 1.0307 by arbitrary precision.
TEST(NotesTest, AVerdictThatWhatIsLeftOutMayTurnSaysSo) {
  const Scene scene = {
      .system = PlanarContact{0.7864519654934002, 0.939606137701005, 12.554953596343825, -0.18993242225129414,
                              -1.5790063416798128},
      .friction = {.kinetic_coefficient = 0.0022966481810994355, .static_coefficient = 1.1947407514087647},
      .restitution = NewtonCoefficient{1.0}};
  const std::vector<Note> notes = NotesOf(scene, {.relative_tolerance = 0.1});
  ASSERT_EQ(notes.size(), 1U);
  EXPECT_EQ(notes[0].path, "admissible");
  EXPECT_THAT(notes[0].text, HasSubstr("above 1"));
  EXPECT_TRUE(NotesOf(scene, {.relative_tolerance = 0.0}).empty());
  Scene plastic = scene;
  plastic.restitution = NewtonCoefficient{0.5};
  EXPECT_TRUE(NotesOf(plastic, {.relative_tolerance = 0.1}).empty());
}

TEST(NotesTest, AnAnswerWithoutTheDurationOfASpringSaysHowToAskForIt) {
  const std::vector<Note> notes = NotesOf(OnALinearSpring());
  ASSERT_EQ(notes.size(), 1U);
  EXPECT_EQ(notes[0].kind, NoteKind::kDurationLeftOut);
  EXPECT_EQ(notes[0].path, "contact");
  EXPECT_THAT(notes[0].text, HasSubstr("--require finite-duration"));
  EXPECT_THAT(NotesOf(OnALinearSpring(), {.required = {Effect::kFiniteDuration}}), IsEmpty());
  EXPECT_THAT(NotesOf(OnALinearSpring(), {.excluded = {Effect::kFiniteDuration}}), IsEmpty());
  EXPECT_THAT(NotesOf(With(Flat())), IsEmpty());
  Scene away = OnALinearSpring();
  std::get<PlanarBody>(away.system).velocity_n_m_s = 3.0;
  EXPECT_THAT(NotesOf(away), IsEmpty());
}

// The contact swings about a hundred times along its fast direction while it parts along the slow one.
TEST(NotesTest, AnImpactInTimeWithoutAnEndSaysThatTheModelWithoutTimeMayHaveOne) {
  const Scene scene = {
      .system = PlanarContact{1282.1704270420028, 50.36621089503721, 1.9784902846306676, 0.0, -0.4469545709171959},
      .friction = {.kinetic_coefficient = 0.051586061716826476},
      .restitution = EnergeticCoefficient{1.0},
      .compliance =
          Compliance{.tangential_ratio_squared = 0.01744040985665638, .normal = LinearSpring{18118.50074304144}}};
  const std::vector<Note> notes = NotesOf(scene, {.relative_tolerance = 1e-3, .required = {Effect::kFiniteDuration}});
  ASSERT_EQ(notes.size(), 1U);
  EXPECT_EQ(notes[0].path, "regime");
  EXPECT_THAT(notes[0].text, HasSubstr("--exclude finite-duration"));
  const auto without = LocalSolver().Solve({.scene = scene, .demand = {.excluded = {Effect::kFiniteDuration}}});
  EXPECT_EQ(without->outcome.regime, Regime::kStickInCompression);
  EXPECT_NEAR(without->outcome.contact_velocity_after.normal_m_s, 0.44694, 1e-5);
}

TEST(NotesTest, AnAngleBeyondAFullTurnIsNotedWithItsRadians) {
  Scene scene = With(Chain());
  EXPECT_THAT(NotesOf(scene), IsEmpty());
  std::get<Linkage>(scene.system).links[1].theta_rad = 20.0;
  const std::vector<Note> notes = NotesOf(scene);
  ASSERT_EQ(notes.size(), 1U);
  EXPECT_EQ(notes[0].kind, NoteKind::kLargeAngle);
  EXPECT_EQ(notes[0].path, "linkage.links[1].theta_rad");
  EXPECT_EQ(
      notes[0].text,
      "linkage.links[1].theta_rad = 20 rad lies beyond a full turn; write 20deg or 0.349 if it is meant in degrees.");
  std::get<Linkage>(scene.system).links[1].theta_rad = -2.0 * std::numbers::pi;
  EXPECT_THAT(NotesOf(scene), IsEmpty());
}

}  // namespace
}  // namespace ricochet
