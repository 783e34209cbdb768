// The promises of Solver::SolveBatch and of batch sessions, for LocalSolver and Client.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <limits>
#include <stop_token>
#include <string>
#include <vector>

#include "core/rows/column.h"
#include "core/scene/field.h"
#include "core/scene/numbers.h"
#include "ricochet/engine_info.h"
#include "tests/contract/solvers.h"
#include "tests/support/scenes/drivable_numbers.h"
#include "tests/support/scenes/system_scenes.h"

namespace ricochet {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

class BatchContract : public testing::TestWithParam<std::string> {
 protected:
  const Solver& solver() const { return GetParam() == "Local" ? Local() : Remote(); }
};

INSTANTIATE_TEST_SUITE_P(Solvers, BatchContract, testing::Values("Local", "Remote"),
                         [](const auto& parameter) { return parameter.param; });

// Columns in memory of their own, in and out.
struct Table {
  explicit Table(std::vector<std::vector<double>> columns_in, size_t columns_out)
      : in(std::move(columns_in)),
        out(columns_out, std::vector<double>(in.front().size(), -1.0)),
        regimes(in.front().size()),
        statuses(in.front().size()) {}

  BatchRows Rows() {
    BatchRows rows;
    for (const auto& column : in) rows.inputs.emplace_back(column);
    for (auto& column : out) rows.outputs.push_back(absl::MakeSpan(column));
    rows.regimes = absl::MakeSpan(regimes);
    rows.statuses = absl::MakeSpan(statuses);
    return rows;
  }

  std::vector<std::vector<double>> in;
  std::vector<std::vector<double>> out;
  std::vector<Regime> regimes;
  std::vector<RowStatus> statuses;
};

std::vector<uint64_t> Bits(const std::vector<std::vector<double>>& columns) {
  std::vector<uint64_t> bits;
  for (const auto& column : columns) {
    for (const double number : column) bits.push_back(std::bit_cast<uint64_t>(number));
  }
  return bits;
}

// One number for each row, different from row to row and not far from `base`.
double Varied(double base, size_t row, size_t field) {
  return base * (1.0 + 0.01 * std::sin(static_cast<double>(7 * row + 3 * field + 1)));
}

// A batch in which every number of the scene that can be driven is a column.
struct Batch {
  BatchSetup setup;
  std::vector<std::vector<double>> in;
};

Batch BatchOf(const Scene& scene, size_t rows) {
  Batch batch = {.setup = {.scene = scene, .columns = Columns(scene)}, .in = {}};
  VisitDrivableNumbers(scene, [&](std::string path, double number) {
    batch.setup.fields.push_back(std::move(path));
    std::vector<double>& column = batch.in.emplace_back();
    for (size_t i = 0; i < rows; ++i) column.push_back(Varied(number, i, batch.in.size() - 1));
  });
  return batch;
}

// The scene of one row.
Scene SceneOf(const Batch& batch, size_t row) {
  Scene scene = batch.setup.scene;
  for (size_t k = 0; k < batch.setup.fields.size(); ++k) {
    EXPECT_TRUE(ResolveField(batch.setup.fields[k], scene)->Set(batch.in[k][row]));
  }
  return scene;
}

Scene PendulumScene() {
  return {.system = Pendulum{.inertia_kg_m2 = 1.0, .a_m = 0.3, .b_m = 1.0, .omega_minus_rad_s = -1.0},
          .friction = {.kinetic_coefficient = 0.1},
          .restitution = EnergeticCoefficient{0.8}};
}

std::vector<Scene> EveryScene() {
  std::vector<Scene> scenes = {PendulumScene()};
  for (const System& system : Systems()) scenes.push_back(With(system));
  for (Scene& scene : std::vector<Scene>(scenes)) {
    scene.restitution = PoissonCoefficient{0.3};
    scene.friction.kinetic_coefficient = 0.05;
    scenes.push_back(scene);
    scene.restitution = NewtonCoefficient{0.6};
    scene.friction.static_coefficient = 0.5;
    scenes.push_back(scene);
  }
  return scenes;
}

TEST_P(BatchContract, GivesEachRowTheBitsOfItsSolve) {
  constexpr size_t kRows = 37;
  for (const Scene& scene : EveryScene()) {
    for (const double tolerance : {1e-12, 1e-6, 0.0}) {
      Batch batch = BatchOf(scene, kRows);
      batch.setup.demand.relative_tolerance = tolerance;
      Table table(batch.in, batch.setup.columns.size());
      const auto response = solver().SolveBatch(batch.setup, table.Rows());
      ASSERT_TRUE(response.ok()) << response.status();
      EXPECT_EQ(response->engine, ThisEngine());
      EXPECT_EQ(response->summary.counts.points, static_cast<int64_t>(kRows));
      const ColumnReader reader(scene, batch.setup.columns);
      std::vector<double> numbers;
      for (size_t i = 0; i < kRows; ++i) {
        const auto solved = Local().Solve({.scene = SceneOf(batch, i), .demand = batch.setup.demand});
        ASSERT_TRUE(solved.ok()) << solved.status();
        const RowStatus status = reader.Read(solved->outcome, numbers).status;
        for (size_t c = 0; c < numbers.size(); ++c) {
          EXPECT_EQ(std::bit_cast<uint64_t>(table.out[c][i]), std::bit_cast<uint64_t>(numbers[c]))
              << batch.setup.columns[c] << " of row " << i << " of system " << scene.system.index();
        }
        EXPECT_EQ(table.regimes[i], solved->outcome.regime);
        EXPECT_EQ(table.statuses[i], status);
      }
    }
  }
}

// Contacts with few columns.
BatchSetup Contacts() {
  return {.scene = With(Contact()),
          .fields = {"planar_contact.tangential_m_s", "planar_contact.normal_m_s", "friction.kinetic_coefficient"},
          .columns = {"contact_velocity_after.tangential_m_s[0]", "contact_velocity_after.normal_m_s"}};
}

TEST_P(BatchContract, ABadRowSpoilsNoOther) {
  Table good({{1, 2, 3, 4, 5}, {-1, -1, -1, -1, -1}, {0.1, 0.2, 0.3, 0.4, 0.5}}, 2);
  Table mixed(
      {{1, kNaN, 3, 4, 5}, {-1, -1, -1, -1, -1}, {0.1, 0.2, -0.3, 0.4, std::numeric_limits<double>::infinity()}}, 2);
  ASSERT_TRUE(solver().SolveBatch(Contacts(), good.Rows()).ok());
  const auto response = solver().SolveBatch(Contacts(), mixed.Rows());
  ASSERT_TRUE(response.ok()) << response.status();
  for (const size_t row : {0u, 3u}) {
    for (size_t c = 0; c < 2; ++c) EXPECT_EQ(mixed.out[c][row], good.out[c][row]);
  }
  for (const size_t row : {1u, 2u, 4u}) {
    for (size_t c = 0; c < 2; ++c) EXPECT_TRUE(std::isnan(mixed.out[c][row]));
  }
  EXPECT_THAT(mixed.statuses, ElementsAre(RowStatus::kOk, RowStatus::kInvalid, RowStatus::kInvalid, RowStatus::kOk,
                                          RowStatus::kInvalid));
  EXPECT_EQ(mixed.regimes[1], Regime::kInvalid);
  const SweepSummary& counts = response->summary.counts;
  EXPECT_EQ(counts.points, 5);
  EXPECT_EQ(counts.by_regime[static_cast<size_t>(Regime::kInvalid)], (Tally{3, 1}));
  EXPECT_THAT(response->summary.bad_rows,
              ElementsAre(BadRow{1, RowStatus::kInvalid, "planar_contact.tangential_m_s", "= nan: must be finite"},
                          BadRow{2, RowStatus::kInvalid, "friction.kinetic_coefficient", "= -0.3: must be >= 0"},
                          BadRow{4, RowStatus::kInvalid, "friction.kinetic_coefficient", "= inf: must be finite"}));
}

TEST_P(BatchContract, NamesTheNumberThatNoDoubleHolds) {
  BatchSetup setup = Contacts();
  setup.columns = {"energy_change_j"};
  Table table({{1, 1e300}, {-1, -1e300}, {0.1, 0.1}}, 1);
  const auto response = solver().SolveBatch(setup, table.Rows());
  ASSERT_TRUE(response.ok()) << response.status();
  EXPECT_THAT(table.statuses, ElementsAre(RowStatus::kOk, RowStatus::kNotRepresentable));
  EXPECT_TRUE(std::isnan(table.out[0][1]));
  EXPECT_THAT(response->summary.bad_rows,
              ElementsAre(BadRow{1, RowStatus::kNotRepresentable, "energy_change_j", "exceeds the largest double"}));
}

TEST_P(BatchContract, DescribesTheFirstBadRowsAlone) {
  Table table({std::vector<double>(100, kNaN), std::vector<double>(100, -1.0), std::vector<double>(100, 0.1)}, 2);
  const auto response = solver().SolveBatch(Contacts(), table.Rows());
  ASSERT_TRUE(response.ok()) << response.status();
  ASSERT_EQ(response->summary.bad_rows.size(), kMostBadRows);
  EXPECT_EQ(response->summary.bad_rows.back().row, static_cast<int64_t>(kMostBadRows) - 1);
  EXPECT_EQ(response->summary.counts.by_regime[static_cast<size_t>(Regime::kInvalid)].count, 100);
}

TEST_P(BatchContract, AWrongSetupFailsTheCallWithEveryViolation) {
  BatchSetup setup = Contacts();
  setup.scene.friction.kinetic_coefficient = -1.0;  // A column cures it.
  setup.scene.restitution = EnergeticCoefficient{-1.0};
  setup.fields[0] = "planar_contact.tangental_m_s";
  setup.columns = {"contact_velocity_after.normal_m_s", "energy_chnge_j", "contact_velocity_after.normal_m_s"};
  Table table({{1}, {-1}, {0.1}}, 3);
  const auto response = solver().SolveBatch(setup, table.Rows());
  EXPECT_EQ(response.status().code(), absl::StatusCode::kInvalidArgument);
  const std::vector<Violation> violations = ViolationsOf(response.status());
  ASSERT_EQ(violations.size(), 4U) << response.status();
  EXPECT_EQ(violations[0].field, "restitution.energetic");
  EXPECT_EQ(violations[1].field, "fields[0]");
  EXPECT_THAT(violations[1].description, HasSubstr("did you mean planar_contact.tangential_m_s?"));
  EXPECT_EQ(violations[2].field, "columns[1]");
  EXPECT_THAT(violations[2].description, HasSubstr("did you mean energy_change_j?"));
  EXPECT_EQ(violations[3].field, "columns[2]");
}

TEST_P(BatchContract, ASetupWithoutFieldsOrColumnsOrWithAFieldTwiceIsRefused) {
  BatchSetup setup = {.scene = With(Contact())};
  EXPECT_THAT(ViolationsOf(solver().SolveBatch(setup, {}).status()),
              ElementsAre(Violation{"fields", "is empty: must name at least one"},
                          Violation{"columns", "is empty: must name at least one"}));
  setup = Contacts();
  setup.fields[1] = setup.fields[0];
  Table table({{1}, {-1}, {0.1}}, 2);
  const std::vector<Violation> violations = ViolationsOf(solver().SolveBatch(setup, table.Rows()).status());
  ASSERT_EQ(violations.size(), 1U);
  EXPECT_EQ(violations[0].field, "fields[1]");
  EXPECT_THAT(violations[0].description, HasSubstr("which fields[0] drives"));
}

TEST_P(BatchContract, AFieldThatAnotherOneSetsNamesIt) {
  BatchSetup setup = {.scene = {.system = Pendulum{1.0, 0.3, 1.0, -1.0}, .restitution = EnergeticCoefficient{0.5}},
                      .fields = {"pendulum.phi_rad", "pendulum.b_m"},
                      .columns = {"coefficients.newton"}};
  Table table({{1}, {1}}, 1);
  const std::vector<Violation> violations = ViolationsOf(solver().SolveBatch(setup, table.Rows()).status());
  ASSERT_EQ(violations.size(), 1U);
  EXPECT_THAT(violations[0].description,
              HasSubstr("not drive pendulum.b_m, which fields[0], pendulum.phi_rad, drives"));
}

TEST_P(BatchContract, OutputsThatShareMemoryAreRefused) {
  Table table({{1, 2}, {-1, -2}, {0.1, 0.2}}, 2);
  BatchRows rows = table.Rows();
  rows.outputs[1] = absl::MakeSpan(const_cast<double*>(rows.inputs[2].data()), 2);
  EXPECT_THAT(ViolationsOf(solver().SolveBatch(Contacts(), rows).status()),
              ElementsAre(Violation{"outputs[1]", "overlaps inputs[2]: must share no memory with another column"}));
  rows = table.Rows();
  rows.outputs[1] = rows.outputs[0];
  EXPECT_THAT(ViolationsOf(solver().SolveBatch(Contacts(), rows).status()),
              ElementsAre(Violation{"outputs[1]", "overlaps outputs[0]: must share no memory with another column"}));
}

TEST_P(BatchContract, ColumnsThatDoNotFitAreNamed) {
  Table table({{1, 2}, {-1}, {0.1, 0.2}}, 2);
  table.out[1].resize(3);
  table.statuses.resize(1);
  EXPECT_THAT(ViolationsOf(solver().SolveBatch(Contacts(), table.Rows()).status()),
              ElementsAre(Violation{"inputs[1]", "has 1 row: must have 2, as many as inputs[0]"},
                          Violation{"outputs[1]", "has 3 rows: must have 2, as many as inputs[0]"},
                          Violation{"statuses", "has 1 row: must have 2, as many as inputs[0]"}));
  Table missing({{1, 2}, {-1, -1}}, 1);
  EXPECT_THAT(ViolationsOf(solver().SolveBatch(Contacts(), missing.Rows()).status()),
              ElementsAre(Violation{"inputs", "has 2 columns: must have 3, one for each of fields"},
                          Violation{"outputs", "has 1 column: must have 2, one for each of columns"}));
}

TEST_P(BatchContract, NoRowsAreAnsweredByAnEmptySummary) {
  Table table({{}, {}, {}}, 2);
  const auto response = solver().SolveBatch(Contacts(), table.Rows());
  ASSERT_TRUE(response.ok()) << response.status();
  EXPECT_EQ(response->summary, BatchSummary());
  auto session = solver().OpenBatches(Contacts());
  ASSERT_TRUE(session.ok());
  EXPECT_TRUE(session->Solve(table.Rows()).ok());
}

std::vector<std::vector<double>> ManyContacts(size_t rows) {
  std::vector<std::vector<double>> in(3, std::vector<double>(rows));
  for (size_t i = 0; i < rows; ++i) {
    in[0][i] = std::sin(static_cast<double>(i));
    in[1][i] = -1.0 - std::cos(static_cast<double>(3 * i));
    in[2][i] = i % 1000 == 999 ? -1.0 : 0.3 + 0.3 * std::sin(static_cast<double>(5 * i));
  }
  return in;
}

TEST_P(BatchContract, PiecesOfABatchAndStepsOfASessionHaveTheBitsOfTheWhole) {
  constexpr size_t kRows = 150'000;  // More than fits a piece of a Client.
  Table whole(ManyContacts(kRows), 2);
  const auto response = solver().SolveBatch(Contacts(), whole.Rows());
  ASSERT_TRUE(response.ok()) << response.status();
  EXPECT_EQ(response->summary.counts.points, static_cast<int64_t>(kRows));
  EXPECT_EQ(response->summary.counts.by_regime[static_cast<size_t>(Regime::kInvalid)], (Tally{150, 999}));
  EXPECT_EQ(response->summary.bad_rows.at(2).row, 2999);
  Table local(ManyContacts(kRows), 2);
  ASSERT_TRUE(Local().SolveBatch(Contacts(), local.Rows()).ok());
  EXPECT_TRUE(Bits(whole.out) == Bits(local.out));
  EXPECT_TRUE(whole.regimes == local.regimes);
  EXPECT_TRUE(whole.statuses == local.statuses);

  auto session = solver().OpenBatches(Contacts());
  ASSERT_TRUE(session.ok());
  Table steps(ManyContacts(kRows), 2);
  const BatchRows all = steps.Rows();
  for (size_t first = 0, size = 1; first < kRows; first += size, size = std::min(3 * size, kRows - first)) {
    BatchRows some;
    for (const auto& column : all.inputs) some.inputs.push_back(column.subspan(first, size));
    for (const auto& column : all.outputs) some.outputs.push_back(column.subspan(first, size));
    ASSERT_TRUE(session->Solve(some).ok());
  }
  EXPECT_TRUE(Bits(whole.out) == Bits(steps.out));
  EXPECT_EQ(session->engine(), ThisEngine());
}

TEST_P(BatchContract, ASessionOutlivesABatchThatDoesNotFit) {
  auto session = solver().OpenBatches(Contacts());
  ASSERT_TRUE(session.ok());
  Table wrong({{1, 2}, {-1}, {0.1, 0.2}}, 2);
  EXPECT_FALSE(session->Solve(wrong.Rows()).ok());
  Table right({{1}, {-1}, {0.1}}, 2);
  EXPECT_TRUE(session->Solve(right.Rows()).ok());
}

TEST_P(BatchContract, EndsAtAStopAndAtItsDeadline) {
  Table table(ManyContacts(1000), 2);
  std::stop_source stop;
  auto session = solver().OpenBatches(Contacts(), {.stop = stop.get_token()});
  ASSERT_TRUE(session.ok());
  EXPECT_TRUE(session->Solve(table.Rows()).ok());
  stop.request_stop();
  EXPECT_EQ(session->Solve(table.Rows()).status().code(), absl::StatusCode::kCancelled);
  const CallOptions late = {.deadline = std::chrono::steady_clock::now() - std::chrono::seconds(1)};
  EXPECT_EQ(solver().SolveBatch(Contacts(), table.Rows(), late).status().code(), absl::StatusCode::kDeadlineExceeded);
}

}  // namespace
}  // namespace ricochet
