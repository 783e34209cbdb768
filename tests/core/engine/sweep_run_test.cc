// SweepRun: points have the same bits whatever the range and the chunks, bad points are kept apart, stops are honoured.

#include "core/engine/sweep_run.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "absl/functional/function_ref.h"
#include "absl/strings/str_cat.h"
#include "core/rows/axis_values.h"
#include "core/types/grid.h"
#include "ricochet/solver.h"
#include "tests/support/scenes/pendulum_columns.h"

namespace ricochet {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

Scene BaseScene() {
  return {.system = Pendulum{.inertia_kg_m2 = 2.0, .a_m = 0.3, .b_m = 1.0, .omega_minus_rad_s = -3.0},
          .friction = {.kinetic_coefficient = 0.1, .static_coefficient = std::nullopt},
          .restitution = EnergeticCoefficient{0.5}};
}

Axis Lin(const std::string& path, double start, double stop, int64_t count) {
  return {path, Linspace{start, stop, count}};
}
Axis List(const std::string& path, std::vector<double> values) { return {path, ListValues{std::move(values)}}; }

SweepRequest MakeRequest(std::vector<Axis> axes, std::vector<std::string> columns = {"coefficients.newton"}) {
  return {.grid = {.scene = BaseScene(), .axes = std::move(axes)}, .columns = std::move(columns)};
}

// Returns a sweep with every regime, bad points and inadmissible ones: 60 x 51 points, less than three blocks.
SweepRequest MixedRequest() {
  std::vector<double> frictions = {-0.02};
  while (frictions.size() < 60) frictions.push_back(0.01 * static_cast<double>(frictions.size() - 1));
  SweepRequest request =
      MakeRequest({List("friction.kinetic_coefficient", frictions), Lin("pendulum.omega_minus_rad_s", -4.0, 1.0, 51)},
                  PendulumColumns());
  request.grid.scene.restitution = NewtonCoefficient{0.5};
  return request;
}

bool Never() { return false; }

// Points holds every point of a run in index order.
struct Points {
  std::vector<std::vector<double>> values;
  std::vector<Regime> regimes;
  SweepSummary summary;
};

Points RunAll(const SweepRequest& request) {
  SweepRequest with_regime = request;
  with_regime.with_regime = true;
  absl::StatusOr<SweepRun> run = SweepRun::Make(with_regime);
  EXPECT_TRUE(run.ok()) << run.status();
  Points points;
  while (run.ok() && !run->ended()) {
    const absl::StatusOr<SweepChunk> chunk = run->NextChunk(Never);
    EXPECT_TRUE(chunk.ok()) << chunk.status();
    if (!chunk.ok()) break;
    for (int64_t i = 0; i < chunk->count; ++i) {
      std::vector<double>& point = points.values.emplace_back();
      for (size_t c = 0; c < request.columns.size(); ++c) {
        point.push_back(chunk->values[c * static_cast<size_t>(chunk->count) + static_cast<size_t>(i)]);
      }
    }
    points.regimes.insert(points.regimes.end(), chunk->regimes.begin(), chunk->regimes.end());
    EXPECT_EQ(chunk->summary.has_value(), run->ended());
    if (run->ended()) points.summary = *chunk->summary;
  }
  return points;
}

bool SameBits(const std::vector<double>& x, const std::vector<double>& y) {
  return std::equal(x.begin(), x.end(), y.begin(), y.end(), [](double left, double right) {
    return std::bit_cast<uint64_t>(left) == std::bit_cast<uint64_t>(right);
  });
}

// Sets the scene of point `index` by hand.
Scene SceneAt(const SweepRequest& request, int64_t index) {
  Scene scene = request.grid.scene;
  std::vector<int64_t> positions(request.grid.axes.size());
  AxisPositions(request.grid, index, absl::MakeSpan(positions));
  scene.friction.kinetic_coefficient = AxisValue(request.grid.axes[0], positions[0]);
  std::get<Pendulum>(scene.system).omega_minus_rad_s = AxisValue(request.grid.axes[1], positions[1]);
  return scene;
}

std::vector<double> ColumnsOf(const Outcome& outcome) {
  return {outcome.coefficients.newton,
          *outcome.coefficients.poisson,
          *outcome.coefficients.energetic,
          outcome.coefficients.tangential,
          outcome.rates_after_rad_s[0],
          outcome.contact_velocity_after.tangential_m_s[0],
          outcome.contact_velocity_after.normal_m_s,
          *outcome.impulse.normal_compression_n_s,
          outcome.impulse.normal_total_n_s,
          outcome.impulse.tangential_n_s[0],
          *outcome.work.normal_compression_j,
          *outcome.work.normal_restitution_j,
          *outcome.work.tangential_compression_j,
          *outcome.work.tangential_restitution_j,
          outcome.work.normal_total_j,
          outcome.work.tangential_total_j,
          outcome.energy_change_j};
}

std::vector<std::string> FieldsOf(const absl::Status& status) {
  EXPECT_EQ(status.code(), absl::StatusCode::kInvalidArgument);
  std::vector<std::string> fields;
  for (const Violation& violation : ViolationsOf(status)) fields.push_back(violation.field);
  return fields;
}

std::vector<std::string> ErrorFields(const SweepRequest& request) { return FieldsOf(SweepRun::Make(request).status()); }

// ---- Points ----

TEST(SweepRunTest, EveryPointHasTheBitsThatSolveGivesItsScene) {
  // Compensated arithmetic alone, plain arithmetic at some points, at most of them, and beside effects that the caller
  // decides on.
  const DemandFields demands[] = {
      {.relative_tolerance = 0.0},      {.relative_tolerance = 2e-15},        {},
      {.relative_tolerance = 1e-9},     {.required = {Effect::kHigherOrder}}, {.excluded = {Effect::kStaticFriction}},
      {.excluded = {Effect::kFriction}}};
  const LocalSolver solver;
  for (const DemandFields& demand : demands) {
    SweepRequest request = MixedRequest();
    request.demand = demand;
    const Points points = RunAll(request);
    ASSERT_EQ(points.values.size(), 3060U);
    for (size_t i = 0; i < points.values.size(); ++i) {
      const auto response = solver.Solve({.scene = SceneAt(request, static_cast<int64_t>(i)), .demand = demand});
      ASSERT_EQ(response.ok(), points.regimes[i] != Regime::kInvalid) << i;
      if (!response.ok()) continue;
      ASSERT_EQ(points.regimes[i], response->outcome.regime) << i;
      ASSERT_TRUE(SameBits(points.values[i], ColumnsOf(response->outcome))) << i;
    }
  }
}

// One point in five is so close to locking that its bound exceeds the tolerance of 1e-12, but not one of 1e-9.
TEST(SweepRunTest, OnlyPointsWhoseBoundExceedsTheToleranceTakeCompensatedArithmetic) {
  std::vector<double> frictions;
  for (int i = 0; i < 500; ++i) frictions.push_back(i % 5 == 2 ? 0.3 * (1.0 - 1e-9) - 1e-12 * i : 5e-4 * (i + 1));
  SweepRequest request = MakeRequest({List("friction.kinetic_coefficient", frictions)}, {"coefficients.poisson"});
  std::vector<Points> points;
  for (const double tolerance : {0.0, 1e-12, 1e-9}) {
    request.demand.relative_tolerance = tolerance;
    points.push_back(RunAll(request));
  }
  int hard_ones_that_differ = 0;
  int easy_ones_that_differ = 0;
  for (size_t i = 0; i < frictions.size(); ++i) {
    const bool hard = i % 5 == 2;
    EXPECT_TRUE(SameBits(points[1].values[i], points[hard ? 0 : 2].values[i])) << i;
    if (SameBits(points[0].values[i], points[2].values[i])) continue;
    ++(hard ? hard_ones_that_differ : easy_ones_that_differ);
  }
  EXPECT_GT(hard_ones_that_differ, 20);  // Rounding is seen.
  EXPECT_GT(easy_ones_that_differ, 20);
}

TEST(SweepRunTest, AnySubRangeHasTheBitsOfTheWhole) {
  SweepRequest request = MixedRequest();  // At the default tolerance both arithmetics occur.
  const Points whole = RunAll(request);
  const std::pair<int64_t, int64_t> ranges[] = {{0, 1},    {7, 8},       {50, 53},   {1023, 1026},
                                                {1, 3060}, {3059, 3060}, {500, 2700}};
  for (const auto& [first, end] : ranges) {
    request.first_index = first;
    request.end_index = end;
    const Points part = RunAll(request);
    ASSERT_EQ(part.values.size(), static_cast<size_t>(end - first));
    for (size_t i = 0; i < part.values.size(); ++i) {
      ASSERT_TRUE(SameBits(part.values[i], whole.values[i + static_cast<size_t>(first)])) << first << " + " << i;
      ASSERT_EQ(part.regimes[i], whole.regimes[i + static_cast<size_t>(first)]);
    }
  }
}

TEST(SweepRunTest, ColumnsDoNotDependOnWhichOthersAreAskedFor) {
  SweepRequest request = MixedRequest();
  const Points whole = RunAll(request);
  for (size_t c = 0; c < PendulumColumns().size(); ++c) {
    request.columns = {PendulumColumns()[c]};
    const Points one = RunAll(request);
    for (size_t i = 0; i < one.values.size(); ++i) {
      ASSERT_TRUE(SameBits({whole.values[i][c]}, one.values[i])) << request.columns[0] << " " << i;
    }
  }
}

TEST(SweepRunTest, ZippedAxesAdvanceTogether) {
  SweepRequest request =
      MakeRequest({List("pendulum.a_m", {1.0, 2.0, 3.0}), List("restitution.newton", {0.1, 0.2, 0.3})},
                  {"coefficients.newton", "contact_velocity_after.normal_m_s"});
  request.grid.combination = Combination::kZip;
  EXPECT_THAT(RunAll(request).values, ElementsAre(ElementsAre(0.1, 3.0 * 0.1), ElementsAre(0.2, testing::DoubleEq(1.2)),
                                                  ElementsAre(0.3, testing::DoubleEq(2.7))));
}

TEST(SweepRunTest, ASweepWithoutAxesIsTheBaseScene) {
  const Points points = RunAll(MakeRequest({}, {"coefficients.energetic"}));
  EXPECT_THAT(points.values, ElementsAre(ElementsAre(0.5)));
  EXPECT_EQ(points.summary.points, 1);
}

TEST(SweepRunTest, AnEmptyRangeIsDoneAtOnce) {
  SweepRequest request = MixedRequest();
  request.first_index = 17;
  request.end_index = 17;
  const Points points = RunAll(request);
  EXPECT_TRUE(points.values.empty());
  EXPECT_EQ(points.summary, SweepSummary());
}

// ---- Bad points ----

TEST(SweepRunTest, BadPointsAreNanAndInvalidAndCountedWithTheFirstIndex) {
  const Points points = RunAll(MakeRequest({List("pendulum.a_m", {1.0, -1.0, 2.0, 0.0, 3.0})}, PendulumColumns()));
  EXPECT_THAT(points.regimes,
              ElementsAre(Regime::kRebound, Regime::kInvalid, Regime::kRebound, Regime::kInvalid, Regime::kRebound));
  for (const size_t i : {1U, 3U}) {
    for (const double value : points.values[i]) EXPECT_TRUE(std::isnan(value));
  }
  EXPECT_EQ(points.summary.by_regime[static_cast<size_t>(Regime::kInvalid)], (Tally{.count = 2, .first_index = 1}));
  EXPECT_EQ(points.summary.by_regime[static_cast<size_t>(Regime::kRebound)], (Tally{.count = 3, .first_index = 0}));
}

TEST(SweepRunTest, NanInBadPointsIsQuiet) {
  const Points points = RunAll(MakeRequest({List("pendulum.a_m", {-1.0})}));
  EXPECT_EQ(std::bit_cast<uint64_t>(points.values[0][0]) & (uint64_t{1} << 51), uint64_t{1} << 51);
}

// A bad point must not leave its mark on the next: the axis leaves the bad value behind.
TEST(SweepRunTest, PointsAfterABadOneAreAsIfItWereNotThere) {
  const Points with = RunAll(MakeRequest({List("friction.kinetic_coefficient", {-0.1, 0.1})}, PendulumColumns()));
  const Points without = RunAll(MakeRequest({List("friction.kinetic_coefficient", {0.1})}, PendulumColumns()));
  EXPECT_TRUE(SameBits(with.values[1], without.values[0]));
}

TEST(SweepRunTest, ARequestedOutputThatOverflowsMakesItsPointInvalid) {
  SweepRequest request = MakeRequest({List("pendulum.inertia_kg_m2", {2.0, 1e308})}, {"energy_change_j"});
  EXPECT_THAT(RunAll(request).regimes, ElementsAre(Regime::kRebound, Regime::kInvalid));
  request.columns = {"coefficients.newton"};  // The point is valid if its energy is not asked for.
  EXPECT_THAT(RunAll(request).regimes, ElementsAre(Regime::kRebound, Regime::kRebound));
}

TEST(SweepRunTest, StaticBelowKineticFrictionIsABadPointWhereverItOccurs) {
  SweepRequest request = MakeRequest({List("friction.kinetic_coefficient", {0.05, 0.15, 0.25})});
  request.grid.scene.friction.static_coefficient = 0.2;
  EXPECT_THAT(RunAll(request).regimes, ElementsAre(Regime::kRebound, Regime::kRebound, Regime::kInvalid));
}

TEST(SweepRunTest, TheSummaryTalliesEveryRegimeAndInadmissiblePoints) {
  const SweepRequest request = MixedRequest();
  const Points points = RunAll(request);
  const LocalSolver solver;
  SweepSummary expected;
  const auto add = [](int64_t index, Tally& tally) {
    if (tally.count == 0) tally.first_index = index;
    ++tally.count;
  };
  for (int64_t i = 0; i < 3060; ++i) {
    const auto response = solver.Solve({.scene = SceneAt(request, i)});
    const Regime regime = response.ok() ? response->outcome.regime : Regime::kInvalid;
    add(i, expected.by_regime[static_cast<size_t>(regime)]);
    if (response.ok() && !response->outcome.admissible) add(i, expected.inadmissible);
    if (response.ok()) add(i, expected.by_model[static_cast<size_t>(response->outcome.plan.model)]);
    ++expected.points;
  }
  EXPECT_EQ(points.summary, expected);
  for (const Regime regime :
       {Regime::kInvalid, Regime::kFrictionless, Regime::kRebound, Regime::kLocked, Regime::kSeparating}) {
    EXPECT_GT(expected.by_regime[static_cast<size_t>(regime)].count, 0) << static_cast<int>(regime);
  }
  EXPECT_GT(expected.inadmissible.count, 0);
}

// Solves the points of a sweep over friction one by one, and gives their tallies.
std::array<Tally, kModelCount> ExpectBitsOfSolve(const DemandFields& demand, double most_friction) {
  SweepRequest request = MakeRequest({{"friction.kinetic_coefficient", Logspace{1e-6, most_friction, 500}},
                                      List("pendulum.omega_minus_rad_s", {-3.0, -1.0})},
                                     PendulumColumns());
  request.demand = demand;
  const Points points = RunAll(request);
  const LocalSolver solver;
  std::array<Tally, kModelCount> expected = {};
  for (int64_t i = 0; i < 1000; ++i) {
    const auto response = solver.Solve({.scene = SceneAt(request, i), .demand = request.demand});
    EXPECT_TRUE(response.ok()) << response.status();
    if (!response.ok()) continue;
    Tally& tally = expected[static_cast<size_t>(response->outcome.plan.model)];
    if (tally.count++ == 0) tally.first_index = i;
    EXPECT_TRUE(SameBits(points.values[static_cast<size_t>(i)], ColumnsOf(response->outcome))) << "point " << i;
  }
  EXPECT_EQ(points.summary.by_model, expected);
  return expected;
}

// The axis begins at x = 3e-6. The closed form answers up to x = 0.9; without the higher orders the plan takes the
// frictionless impact first, then the first order in x.
TEST(SweepRunTest, EachRunOfPointsIsSolvedByTheModelOfItsPlanWithTheBitsOfSolve) {
  const auto all = ExpectBitsOfSolve({.relative_tolerance = 1e-3}, 0.27);
  EXPECT_EQ(all[static_cast<size_t>(Model::kPendulum)].count, 1000);
  const auto some = ExpectBitsOfSolve({.relative_tolerance = 1e-3, .excluded = {Effect::kHigherOrder}}, 0.14);
  for (const Model model : {Model::kFrictionless, Model::kFirstOrder}) {
    EXPECT_GT(some[static_cast<size_t>(model)].count, 0) << static_cast<int>(model);
  }
}

TEST(SweepRunTest, FirstIndicesOfASubRangeAreThoseOfTheGrid) {
  SweepRequest request = MakeRequest({List("pendulum.a_m", {1.0, 1.0, -1.0, 1.0})});
  request.first_index = 1;
  const SweepSummary summary = RunAll(request).summary;
  EXPECT_EQ(summary.points, 3);
  EXPECT_EQ(summary.by_regime[static_cast<size_t>(Regime::kRebound)], (Tally{.count = 2, .first_index = 1}));
  EXPECT_EQ(summary.by_regime[static_cast<size_t>(Regime::kInvalid)], (Tally{.count = 1, .first_index = 2}));
}

TEST(SweepRunTest, TheTalliesOfEachChunkAreTheSummaryOfTheRangeUpToItsEnd) {
  const SweepRequest request = MixedRequest();
  absl::StatusOr<SweepRun> run = SweepRun::Make(request);
  ASSERT_TRUE(run.ok());
  int chunks = 0;
  for (; !run->ended(); ++chunks) {
    const absl::StatusOr<SweepChunk> chunk = run->NextChunk(Never);
    ASSERT_TRUE(chunk.ok());
    SweepRequest so_far = request;
    so_far.end_index = chunk->first_index + chunk->count;
    EXPECT_EQ(chunk->tallies, RunAll(so_far).summary);
  }
  EXPECT_GT(chunks, 1);
}

TEST(SweepRunTest, TheSummariesOfTwoPartsJoinToThatOfTheWhole) {
  SweepRequest first = MixedRequest();
  SweepRequest second = first;
  const SweepSummary whole = RunAll(first).summary;
  for (const int64_t cut : {0, 1, 777, 2040, 3060}) {
    first.end_index = second.first_index = cut;
    EXPECT_EQ(Joined(RunAll(first).summary, RunAll(second).summary), whole) << cut;
  }
}

// Figure 4 of the paper is a sweep of Newton's coefficient over phi.
TEST(SweepRunTest, PhiSweepsTheAngleOfFigure4) {
  SweepRequest request = MakeRequest({Lin("pendulum.phi_rad", 0.2, 1.5, 14)});
  request.grid.scene.restitution = EnergeticCoefficient{1.0};
  const Points points = RunAll(request);
  for (int i = 0; i < 14; ++i) {
    const double tangent = std::tan(0.2 + 0.1 * i);
    EXPECT_NEAR(points.values[static_cast<size_t>(i)][0], std::sqrt((tangent - 0.1) / (tangent + 0.1)), 1e-14);
  }
}

// ---- Many violations ----

std::string MessageOf(const SweepRequest& request) { return std::string(SweepRun::Make(request).status().message()); }

Scene LongChain(size_t links) {
  Scene scene = MakeRequest({}).grid.scene;
  scene.system = Linkage{std::vector<Link>(links, Link{1.0, 1.0, 0.5, 0.1, 0.3, -1.0})};
  return scene;
}

TEST(SweepRunTest, ManyUnknownNamesAreRefusedBriefly) {
  SweepRequest request = MakeRequest({});
  request.grid.scene = LongChain(1000);
  request.columns.assign(1000, "no.such.column");
  EXPECT_LT(MessageOf(request).size(), 4096);
  EXPECT_THAT(MessageOf(request), testing::AllOf(HasSubstr("columns[19]"), HasSubstr("and more violations")));
  request.columns = {"coefficients.newton"};
  request.grid.axes.assign(1000, Lin("no.such.field", 0.0, 1.0, 2));
  EXPECT_LT(MessageOf(request).size(), 4096);
  EXPECT_THAT(MessageOf(request), HasSubstr("axes[19].path"));
  request.grid.axes = {Lin(std::string(100'000, '\x01'), 0.0, 1.0, 2)};
  EXPECT_LT(MessageOf(request).size(), 1024);
}

TEST(SweepRunTest, ManyBadValuesOfAListAreRefusedBriefly) {
  SweepRequest request = MakeRequest({Lin("pendulum.b_m", 0.0, 1.0, 2)});
  request.grid.axes[0].values = ListValues{std::vector<double>(65'536, std::nan(""))};
  EXPECT_LT(MessageOf(request).size(), 4096);
}

// The driven fields are bad in the base scene, which the axes cure; the field behind them stays bad.
TEST(SweepRunTest, ABadFieldBehindManyThatTheAxesCureIsFound) {
  SweepRequest request = MakeRequest({});
  request.grid.scene = LongChain(40);
  auto& links = std::get<Linkage>(request.grid.scene.system).links;
  for (size_t i = 0; i < links.size(); ++i) {
    links[i].mass_kg = -1.0;
    if (i < 39) request.grid.axes.push_back(Lin(absl::StrCat("linkage.links[", i, "].mass_kg"), 1.0, 1.0, 1));
  }
  EXPECT_EQ(MessageOf(request), "linkage.links[39].mass_kg = -1: must be > 0");
  links[39].mass_kg = 1.0;
  EXPECT_EQ(MessageOf(request), "");
}

// ---- Chunks and stops ----

TEST(SweepRunTest, ChunksStartSmallAndHoldAtMost512KiB) {
  for (const size_t columns : {size_t{1}, size_t{8}, PendulumColumns().size()}) {
    SweepRequest request = MakeRequest({Lin("pendulum.b_m", 0.0, 1.0, 1'000'000'000)}, PendulumColumns());
    request.columns.resize(columns);
    absl::StatusOr<SweepRun> run = SweepRun::Make(request);
    ASSERT_TRUE(run.ok());
    EXPECT_EQ(run->points_total(), 1'000'000'000);
    const absl::StatusOr<SweepChunk> first = run->NextChunk(Never);
    ASSERT_TRUE(first.ok());
    EXPECT_EQ(first->first_index, 0);
    EXPECT_LE(first->values.size() * sizeof(double), size_t{256} << 10);
    const absl::StatusOr<SweepChunk> second = run->NextChunk(Never);
    ASSERT_TRUE(second.ok());
    EXPECT_EQ(second->first_index, first->count);
    EXPECT_GE(second->values.size() * sizeof(double), size_t{256} << 10);
    EXPECT_LE(second->values.size() * sizeof(double), size_t{512} << 10);
  }
}

TEST(SweepRunTest, ChunksTileTheRangeWithoutGapOrOverlap) {
  SweepRequest request = MakeRequest({Lin("pendulum.b_m", 0.0, 1.0, 300'000)});
  request.first_index = 5;
  request.end_index = 250'000;
  absl::StatusOr<SweepRun> run = SweepRun::Make(request);
  ASSERT_TRUE(run.ok());
  int64_t next = 5;
  while (!run->ended()) {
    const absl::StatusOr<SweepChunk> chunk = run->NextChunk(Never);
    ASSERT_TRUE(chunk.ok());
    ASSERT_EQ(chunk->first_index, next);
    ASSERT_GT(chunk->count, 0);
    EXPECT_EQ(chunk->values.size(), static_cast<size_t>(chunk->count));
    EXPECT_TRUE(chunk->regimes.empty());
    next += chunk->count;
    EXPECT_EQ(chunk->points_done, next - 5);
    EXPECT_EQ(chunk->points_total, 249'995);
  }
  EXPECT_EQ(next, 250'000);
}

// Returns the sweep's points; each chunk ends once `is_enough` says so.
SweepChunk Whole(const SweepRequest& request, absl::FunctionRef<bool()> is_enough, int& chunks) {
  absl::StatusOr<SweepRun> run = SweepRun::Make(request);
  EXPECT_TRUE(run.ok()) << run.status();
  SweepChunk whole;
  const size_t columns = request.columns.size();
  std::vector<std::vector<double>> values(columns);
  for (chunks = 0; run.ok() && !run->ended(); ++chunks) {
    const absl::StatusOr<SweepChunk> chunk = run->NextChunk(Never, is_enough);
    EXPECT_TRUE(chunk.ok()) << chunk.status();
    EXPECT_EQ(chunk->first_index, whole.count);
    EXPECT_EQ(chunk->values.size(), static_cast<size_t>(chunk->count) * columns);
    for (size_t c = 0; c < columns; ++c) {
      const auto first = chunk->values.begin() + static_cast<int64_t>(c) * chunk->count;
      values[c].insert(values[c].end(), first, first + chunk->count);
    }
    whole.regimes.insert(whole.regimes.end(), chunk->regimes.begin(), chunk->regimes.end());
    whole.count += chunk->count;
    whole.summary = chunk->summary;
  }
  for (const std::vector<double>& column : values) {
    whole.values.insert(whole.values.end(), column.begin(), column.end());
  }
  return whole;
}

TEST(SweepRunTest, PointsAreTheSameWhereverAChunkEndsEarly) {
  SweepRequest pendulum =
      MakeRequest({Lin("pendulum.b_m", 0.0, 1.0, 10'000)}, {"coefficients.newton", "impulse.normal_total_n_s"});
  pendulum.with_regime = true;
  SweepRequest contact = pendulum;
  contact.grid.scene.system = PlanarContact{2.5, 1.0, 2.5, -0.5, -1.0};
  contact.grid.axes = {Lin("friction.kinetic_coefficient", 0.0, 1.0, 10'000)};
  // No lanes give this column, so that the points are solved one by one.
  SweepRequest one_by_one = contact;
  one_by_one.grid.axes = {Lin("friction.kinetic_coefficient", 0.0, 1.0, 3'000)};
  one_by_one.columns.push_back("accuracy.relative_error");
  for (const SweepRequest& request : {pendulum, contact, one_by_one}) {
    int chunks = 0;
    const SweepChunk whole = Whole(
        request, [] { return false; }, chunks);
    EXPECT_LE(chunks, 2);
    int asked = 0;
    const SweepChunk cut = Whole(
        request, [&asked] { return ++asked % 5 == 0; }, chunks);
    EXPECT_GT(chunks, 2);
    EXPECT_EQ(cut, whole);
    const SweepChunk single = Whole(
        request, [] { return true; }, chunks);
    EXPECT_EQ(single, whole);
  }
}

TEST(SweepRunTest, AStopIsLookedForBeforeEvery1024Points) {
  absl::StatusOr<SweepRun> run = SweepRun::Make(MakeRequest({Lin("pendulum.b_m", 0.0, 1.0, 60'000)}));
  ASSERT_TRUE(run.ok());
  int64_t looks = 0;
  while (!run->ended()) {
    const int64_t looks_before = looks;
    const absl::StatusOr<SweepChunk> chunk = run->NextChunk([&looks] {
      ++looks;
      return false;
    });
    ASSERT_TRUE(chunk.ok());
    EXPECT_GE((looks - looks_before) * SweepRun::kPointsBetweenStops, chunk->count);
  }
}

TEST(SweepRunTest, AfterAStopNoMoreThan1024PointsAreComputed) {
  absl::StatusOr<SweepRun> run = SweepRun::Make(MakeRequest({Lin("pendulum.b_m", 0.0, 1.0, 60'000)}));
  ASSERT_TRUE(run.ok());
  const absl::StatusOr<SweepChunk> first = run->NextChunk(Never);
  ASSERT_TRUE(first.ok());
  int looks = 0;
  const absl::StatusOr<SweepChunk> second = run->NextChunk([&looks] { return ++looks == 4; });
  EXPECT_EQ(second.status().code(), absl::StatusCode::kCancelled);
  EXPECT_EQ(looks, 4);
  EXPECT_EQ(run->points_done(), first->count + 3 * SweepRun::kPointsBetweenStops);
}

// ---- Bad requests ----

TEST(SweepRunTest, ColumnsMustBeNamedKnownAndDifferent) {
  EXPECT_THAT(ErrorFields(MakeRequest({}, {})), ElementsAre("columns"));
  EXPECT_THAT(ErrorFields(MakeRequest({}, {"coefficients.newton", "coefficients.nwton", ""})),
              ElementsAre("columns[1]", "columns[2]"));
  EXPECT_THAT(ErrorFields(MakeRequest({}, {"energy_change_j", "coefficients.newton", "energy_change_j"})),
              ElementsAre("columns[2]"));
  EXPECT_THAT(std::string(SweepRun::Make(MakeRequest({}, {"nonsense"})).status().message()),
              HasSubstr("`ricochet sweep --column '?'` lists them"));
}

TEST(SweepRunTest, UnknownPathsOfAxesAreRefused) {
  EXPECT_THAT(ErrorFields(MakeRequest({Lin("pendulum.c_m", 0, 1, 2), Lin("pendulum.b_m", 0, 1, 2)})),
              ElementsAre("axes[0].path"));
}

TEST(SweepRunTest, TwoAxesMustNotDriveTheSameField) {
  const std::pair<const char*, const char*> clashes[] = {{"pendulum.a_m", "pendulum.a_m"},
                                                         {"pendulum.phi_rad", "pendulum.a_m"},
                                                         {"pendulum.b_m", "pendulum.phi_rad"},
                                                         {"restitution.newton", "restitution.poisson"}};
  for (const auto& [first, second] : clashes) {
    const absl::Status status = SweepRun::Make(MakeRequest({Lin(first, 0.1, 1, 2), Lin(second, 0.1, 1, 2)})).status();
    EXPECT_THAT(FieldsOf(status), Contains("axes[1].path")) << first << " " << second;
    EXPECT_THAT(std::string(status.message()), HasSubstr("axes[0]"));
  }
}

TEST(SweepRunTest, TheRangeMustLieInTheGrid) {
  const auto with_range = [](int64_t first, std::optional<int64_t> end) {
    SweepRequest request = MakeRequest({Lin("pendulum.b_m", 0, 1, 10)});
    request.first_index = first;
    request.end_index = end;
    return request;
  };
  EXPECT_THAT(ErrorFields(with_range(-1, std::nullopt)), ElementsAre("first_index"));
  EXPECT_THAT(ErrorFields(with_range(11, std::nullopt)), ElementsAre("first_index"));
  EXPECT_THAT(ErrorFields(with_range(6, 5)), ElementsAre("first_index"));
  EXPECT_THAT(ErrorFields(with_range(0, 11)), ElementsAre("end_index"));
  EXPECT_THAT(ErrorFields(with_range(0, -1)), ElementsAre("end_index"));
  EXPECT_TRUE(SweepRun::Make(with_range(10, std::nullopt)).ok());
}

TEST(SweepRunTest, TheBaseSceneMustBeValidWhereNoAxisDrivesIt) {
  SweepRequest request = MakeRequest({Lin("pendulum.b_m", 0, 1, 10)});
  std::get<Pendulum>(request.grid.scene.system).a_m = 0.0;
  request.grid.scene.friction.kinetic_coefficient = kNan;
  EXPECT_THAT(ErrorFields(request), ElementsAre("pendulum.a_m", "friction.kinetic_coefficient"));
}

TEST(SweepRunTest, AFieldThatAnAxisDrivesNeedsNoBaseValue) {
  SweepRequest request = MakeRequest({List("restitution.newton", {0.25}), List("pendulum.a_m", {1.0})});
  request.grid.scene.restitution = std::monostate();
  std::get<Pendulum>(request.grid.scene.system).a_m = kNan;
  EXPECT_THAT(RunAll(request).values, ElementsAre(ElementsAre(0.25)));
}

TEST(SweepRunTest, AnAngleNeedsTheBaseScenesDistance) {
  SweepRequest request = MakeRequest({Lin("pendulum.phi_rad", 0.1, 1, 10)});
  std::get<Pendulum>(request.grid.scene.system).b_m = kNan;
  EXPECT_THAT(ErrorFields(request), ElementsAre("pendulum.b_m"));
}

TEST(SweepRunTest, AllThatIsWrongIsReportedAtOnce) {
  SweepRequest request = MakeRequest({Lin("pendulum.c_m", 0, 1, 2), Lin("pendulum.b_m", 0, kNan, 0)}, {"x"});
  request.grid.scene.friction.kinetic_coefficient = -1.0;
  EXPECT_THAT(ErrorFields(request),
              testing::UnorderedElementsAre("friction.kinetic_coefficient", "axes[0].path", "axes[1].linspace.stop",
                                            "axes[1].linspace.count", "columns[0]"));
}

TEST(SweepRunTest, ASweepWithoutASystemSaysSo) {
  SweepRequest request = MakeRequest({Lin("pendulum.b_m", 0, 1, 2)});
  request.grid.scene.system = std::monostate();
  EXPECT_THAT(ErrorFields(request), Contains("system"));
}

}  // namespace
}  // namespace ricochet
