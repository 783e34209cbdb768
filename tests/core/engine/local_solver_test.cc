// LocalSolver: answers with their timelines, histories, limits and errors.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <stop_token>
#include <string>
#include <vector>

#include "core/bounds/pendulum_bounds.h"
#include "core/engine/sweep_run.h"
#include "core/models/pendulum/pendulum.h"
#include "core/plan/scene_problem.h"
#include "core/rows/scene_lanes.h"
#include "ricochet/engine_info.h"
#include "ricochet/error.h"
#include "ricochet/solver.h"
#include "tests/support/scenes/pendulum_columns.h"

namespace ricochet {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

// a = 0.75, mu |b| = 0.25: r = 1/2, tau0 = 6, all exact.
Scene ExactScene(Restitution restitution = PoissonCoefficient{1.0}) {
  return {.system = Pendulum{.inertia_kg_m2 = 2.0, .a_m = 0.75, .b_m = -1.0, .omega_minus_rad_s = -3.0},
          .friction = {.kinetic_coefficient = 0.25, .static_coefficient = std::nullopt},
          .restitution = restitution};
}

Pendulum& PendulumOf(Scene& scene) { return std::get<Pendulum>(scene.system); }

Outcome SolveScene(const Scene& scene, const std::vector<double>& history = {}) {
  const auto response = LocalSolver().Solve({.scene = scene, .history_at_n_s = history});
  EXPECT_TRUE(response.ok()) << response.status();
  return response.ok() ? response->outcome : Outcome();
}

std::vector<EventKind> KindsOf(const std::vector<Event>& timeline) {
  std::vector<EventKind> kinds;
  for (const Event& event : timeline) kinds.push_back(event.kind);
  return kinds;
}

std::vector<LimitKind> KindsOf(const std::vector<BrokenLimit>& limits) {
  std::vector<LimitKind> kinds;
  for (const BrokenLimit& limit : limits) kinds.push_back(limit.kind);
  return kinds;
}

// ---- Solve ----

TEST(LocalSolverTest, OutcomeHoldsWhatTheModelComputes) {
  const Outcome outcome = SolveScene(ExactScene());
  EXPECT_EQ(outcome.regime, Regime::kRebound);
  EXPECT_TRUE(outcome.admissible);
  EXPECT_EQ(outcome.w_rank, 1);
  EXPECT_EQ(outcome.coefficients.newton, 0.5);
  EXPECT_EQ(outcome.coefficients.poisson, 1.0);
  EXPECT_DOUBLE_EQ(*outcome.coefficients.energetic, std::sqrt(0.5));
  EXPECT_EQ(outcome.coefficients.tangential, 0.0);
  EXPECT_THAT(outcome.rates_after_rad_s, ElementsAre(1.5));
  EXPECT_THAT(outcome.contact_velocity_after.tangential_m_s, ElementsAre(-1.5));
  EXPECT_EQ(outcome.contact_velocity_after.normal_m_s, 1.125);
  EXPECT_EQ(outcome.impulse.normal_compression_n_s, 6.0);
  EXPECT_EQ(outcome.impulse.normal_total_n_s, 12.0);
  EXPECT_THAT(outcome.impulse.tangential_n_s, ElementsAre(0.0));
  EXPECT_EQ(outcome.work.normal_compression_j, -6.75);
  EXPECT_EQ(outcome.work.normal_restitution_j, 3.375);
  EXPECT_EQ(outcome.work.tangential_compression_j, -2.25);
  EXPECT_EQ(outcome.work.tangential_restitution_j, -1.125);
  EXPECT_EQ(outcome.work.normal_total_j, -3.375);
  EXPECT_EQ(outcome.work.tangential_total_j, -3.375);
  EXPECT_EQ(outcome.energy_change_j, -6.75);
  EXPECT_EQ(outcome.work.residual_j, 0.0);
}

TEST(LocalSolverTest, TimelineRunsFromTheStartOverTheEndOfSlipAndCompressionToTheEnd) {
  const Outcome outcome = SolveScene(ExactScene(PoissonCoefficient{0.5}));
  ASSERT_THAT(KindsOf(outcome.timeline), ElementsAre(EventKind::kStart, EventKind::kSlipStops,
                                                     EventKind::kCompressionEnds, EventKind::kRestitutionEnds));
  const State& start = outcome.timeline[0].state;
  EXPECT_EQ(start.normal_impulse_n_s, 0.0);
  EXPECT_THAT(start.rates_rad_s, ElementsAre(-3.0));
  EXPECT_THAT(start.contact_velocity.tangential_m_s, ElementsAre(3.0));
  EXPECT_EQ(start.contact_velocity.normal_m_s, -2.25);
  const State& rest = outcome.timeline[2].state;
  EXPECT_EQ(rest.normal_impulse_n_s, 6.0);
  EXPECT_THAT(rest.rates_rad_s, ElementsAre(0.0));
  EXPECT_THAT(rest.tangential_impulse_n_s, ElementsAre(-1.5));
  EXPECT_EQ(outcome.timeline[1].state, rest);
  const State& end = outcome.timeline[3].state;
  EXPECT_EQ(end.normal_impulse_n_s, outcome.impulse.normal_total_n_s);
  EXPECT_EQ(end.rates_rad_s, outcome.rates_after_rad_s);
  EXPECT_EQ(end.tangential_impulse_n_s, outcome.impulse.tangential_n_s);
}

TEST(LocalSolverTest, LockedImpactHasNoRestitutionAndSeparatingNoTimeline) {
  Scene scene = ExactScene();
  scene.friction.static_coefficient = 0.75;
  EXPECT_THAT(KindsOf(SolveScene(scene).timeline),
              ElementsAre(EventKind::kStart, EventKind::kSlipStops, EventKind::kCompressionEnds));
  PendulumOf(scene).omega_minus_rad_s = 1.0;
  const Outcome separating = SolveScene(scene);
  EXPECT_EQ(separating.regime, Regime::kSeparating);
  EXPECT_THAT(separating.timeline, IsEmpty());
  EXPECT_THAT(separating.rates_after_rad_s, ElementsAre(1.0));
  EXPECT_TRUE(separating.admissible);
}

TEST(LocalSolverTest, BrokenLimitsAreNamedWithValueLimitAndExcess) {
  const Outcome sharp = SolveScene(ExactScene(NewtonCoefficient{1.0}));
  EXPECT_FALSE(sharp.admissible);
  ASSERT_THAT(KindsOf(sharp.broken_limits), ElementsAre(LimitKind::kSharp));
  EXPECT_DOUBLE_EQ(sharp.broken_limits[0].value, std::sqrt(2.0));
  EXPECT_EQ(sharp.broken_limits[0].limit, 1.0);
  EXPECT_DOUBLE_EQ(sharp.broken_limits[0].excess, std::sqrt(2.0) - 1.0);

  const Outcome both = SolveScene(ExactScene(NewtonCoefficient{2.0}));
  ASSERT_THAT(KindsOf(both.broken_limits), ElementsAre(LimitKind::kSharp, LimitKind::kEnergy));
  EXPECT_EQ(both.broken_limits[1].value, 27.0);
  EXPECT_EQ(both.broken_limits[1].limit, 0.0);
  EXPECT_EQ(both.broken_limits[1].excess, 27.0);
  EXPECT_EQ(both.energy_change_j, 27.0);
}

TEST(LocalSolverTest, AnInadmissibleOutcomeIsAnErrorOnlyWhereAsked) {
  SolveRequest request = {.scene = ExactScene(NewtonCoefficient{2.0})};
  EXPECT_TRUE(LocalSolver().Solve(request).ok());
  request.inadmissible_is_error = true;
  const absl::Status status = LocalSolver().Solve(request).status();
  EXPECT_EQ(status.code(), absl::StatusCode::kFailedPrecondition);
  EXPECT_EQ(ReasonOf(status), ErrorReason::kInadmissibleOutcome);
  EXPECT_THAT(std::string(status.message()), HasSubstr("27"));
  request.scene = ExactScene(NewtonCoefficient{0.5});
  EXPECT_TRUE(LocalSolver().Solve(request).ok());
}

TEST(LocalSolverTest, ALawWithoutASolutionIsAnErrorOnlyWhereAsked) {
  // Wnn + mu_hat Wtn = -0.5: the impulse would increase the approach velocity.
  SolveRequest request = {
      .scene = {.system = PlanarContact{2.5, -1.5, 1.0, 1.0, -1.0}, .impact_law = BrachLaw{0.5, 1.0}}};
  const auto response = LocalSolver().Solve(request);
  ASSERT_TRUE(response.ok()) << response.status();
  EXPECT_EQ(response->outcome.regime, Regime::kNoSolution);
  request.inadmissible_is_error = true;
  const absl::Status status = LocalSolver().Solve(request).status();
  EXPECT_EQ(status.code(), absl::StatusCode::kFailedPrecondition);
  EXPECT_EQ(ReasonOf(status), ErrorReason::kInadmissibleOutcome);
}

TEST(LocalSolverTest, ABadSceneListsItsViolations) {
  Scene scene = ExactScene();
  PendulumOf(scene).a_m = 0.0;
  scene.friction.kinetic_coefficient = -1.0;
  const absl::Status status = LocalSolver().Solve({.scene = scene}).status();
  EXPECT_EQ(status.code(), absl::StatusCode::kInvalidArgument);
  EXPECT_THAT(ViolationsOf(status), ElementsAre(Violation{"pendulum.a_m", "= 0: must be > 0"},
                                                Violation{"friction.kinetic_coefficient", "= -1: must be >= 0"}));
}

TEST(LocalSolverTest, ABadSceneDoesNotHideWhatElseIsWrong) {
  Scene scene = ExactScene();
  PendulumOf(scene).a_m = 0.0;
  const DemandFields demand = {.relative_tolerance = 5.0};
  const auto fields = [](const absl::Status& status) {
    std::vector<std::string> names;
    for (const Violation& violation : ViolationsOf(status)) names.push_back(violation.field);
    return names;
  };
  EXPECT_THAT(fields(LocalSolver()
                         .Solve({.scene = scene, .history_intervals = -1, .demand = demand, .force_intervals = -2})
                         .status()),
              ElementsAre("pendulum.a_m", "relative_tolerance", "force_intervals", "history_intervals"));
  EXPECT_THAT(fields(LocalSolver().Plan({.scene = scene, .demand = demand}).status()),
              ElementsAre("pendulum.a_m", "relative_tolerance"));
  const SweepRequest sweep = {.grid = {.scene = scene, .axes = {{"pendulum.b_m", Linspace{-2.0, 2.0, 3}}}},
                              .columns = {"coefficients.newton"},
                              .first_index = -1,
                              .end_index = 9,
                              .demand = demand};
  for (const absl::StatusOr<SweepChunk>& chunk : LocalSolver().Sweep(sweep)) {
    EXPECT_THAT(fields(chunk.status()), ElementsAre("pendulum.a_m", "relative_tolerance", "end_index", "first_index"));
  }
}

// The place is that in the list of the request, in whatever order it names the effects.
TEST(LocalSolverTest, AnEffectIsNamedByItsPlaceInTheList) {
  const auto fields = [](const DemandFields& demand) {
    std::vector<std::string> names;
    for (const Violation& violation :
         ViolationsOf(LocalSolver().Solve({.scene = ExactScene(), .demand = demand}).status())) {
      names.push_back(violation.field);
    }
    return names;
  };
  EXPECT_THAT(fields({.required = {Effect::kFiniteDuration, Effect::kFriction}}), ElementsAre("required[0]"));
  EXPECT_THAT(fields({.required = {Effect::kFriction, Effect::kFiniteDuration}}), ElementsAre("required[1]"));
  EXPECT_THAT(fields({.required = {Effect::kFriction}, .excluded = {Effect::kHigherOrder, Effect::kFriction}}),
              testing::Contains("required[0]"));
}

TEST(LocalSolverTest, AnOutputAboveTheLargestDoubleIsNamed) {
  Scene scene = ExactScene();
  PendulumOf(scene).inertia_kg_m2 = 1e308;
  PendulumOf(scene).omega_minus_rad_s = -0.5;
  const absl::Status energy = LocalSolver().Solve({.scene = scene}).status();
  EXPECT_TRUE(energy.ok()) << energy;
  PendulumOf(scene).omega_minus_rad_s = -2.5;
  const absl::Status status = LocalSolver().Solve({.scene = scene}).status();
  EXPECT_EQ(status.code(), absl::StatusCode::kOutOfRange);
  EXPECT_EQ(ReasonOf(status), ErrorReason::kOutputOverflow);
  EXPECT_THAT(std::string(status.message()), HasSubstr("outcome.impulse.normal_compression_n_s"));
}

TEST(LocalSolverTest, EveryAnswerCarriesTheEngine) {
  const auto response = LocalSolver().Solve({.scene = ExactScene()});
  ASSERT_TRUE(response.ok());
  EXPECT_EQ(response->engine, ThisEngine());
  EXPECT_EQ(response->engine.fingerprint.size(), 16U);
  EXPECT_THAT(response->engine.version, testing::MatchesRegex("[0-9]+\\.[0-9]+\\.[0-9]+"));
}

// ---- Histories ----

TEST(LocalSolverTest, HistoryGivesTheStateAtEachImpulseInTheOrderAsked) {
  const std::vector<double> taus = {12.0, 0.0, 6.0, 9.0, 3.0};
  const Outcome outcome = SolveScene(ExactScene(), taus);
  ASSERT_EQ(outcome.history.size(), taus.size());
  const pendulum::Problem problem = pendulum::MakeProblem(ExactScene());
  for (size_t i = 0; i < taus.size(); ++i) {
    const State& state = outcome.history[i];
    const pendulum::Instant instant = pendulum::At(problem, taus[i]);
    EXPECT_EQ(state.normal_impulse_n_s, taus[i]);
    EXPECT_THAT(state.rates_rad_s, ElementsAre(instant.omega));
    EXPECT_THAT(state.tangential_impulse_n_s, ElementsAre(instant.tangential_impulse));
    EXPECT_EQ(state.contact_velocity.normal_m_s, 0.75 * instant.omega);
    EXPECT_THAT(state.contact_velocity.tangential_m_s, ElementsAre(-1.0 * instant.omega));
  }
}

TEST(LocalSolverTest, HistoryBeyondTheImpactNamesIndexAndValue) {
  const double beyond = std::nextafter(12.0, 13.0);
  const auto response =
      LocalSolver().Solve({.scene = ExactScene(), .history_at_n_s = {0.0, -1.0, 12.0, beyond, std::nan("")}});
  EXPECT_EQ(response.status().code(), absl::StatusCode::kInvalidArgument);
  const std::vector<Violation> violations = ViolationsOf(response.status());
  ASSERT_EQ(violations.size(), 3U);
  EXPECT_EQ(violations[0], (Violation{"history_at_n_s[1]", "= -1: must be in [0, tau1 = 12]"}));
  EXPECT_EQ(violations[1].field, "history_at_n_s[3]");
  EXPECT_THAT(violations[1].description, HasSubstr("12.000000000000002"));
  EXPECT_EQ(violations[2].field, "history_at_n_s[4]");
}

TEST(LocalSolverTest, HistoryEndsWhereTheImpactEnds) {
  const Outcome ended = SolveScene(ExactScene());
  const Outcome outcome = SolveScene(ExactScene(), {ended.impulse.normal_total_n_s});
  EXPECT_EQ(outcome.history[0], outcome.timeline.back().state);
}

TEST(LocalSolverTest, SeparatingContactHasAHistoryOfOneInstant) {
  Scene scene = ExactScene();
  PendulumOf(scene).omega_minus_rad_s = 2.0;
  EXPECT_THAT(SolveScene(scene, {0.0}).history[0].rates_rad_s, ElementsAre(2.0));
  EXPECT_FALSE(LocalSolver().Solve({.scene = scene, .history_at_n_s = {0.5}}).ok());
}

TEST(LocalSolverTest, HistoriesLongerThan65536AreRefused) {
  SolveRequest request = {.scene = ExactScene()};
  request.history_at_n_s.assign(kMostIntervals + 1, 1.0);
  EXPECT_TRUE(LocalSolver().Solve(request).ok());
  request.history_at_n_s.push_back(1.0);
  const absl::Status status = LocalSolver().Solve(request).status();
  ASSERT_EQ(ViolationsOf(status).size(), 1U);
  EXPECT_EQ(ViolationsOf(status)[0].field, "history_at_n_s");
}

TEST(LocalSolverTest, IntervalsOfAHistoryAreEqualStepsOfTheImpulse) {
  const Outcome listed = SolveScene(ExactScene(), {0.0, 3.0, 6.0, 9.0, 12.0});
  const auto stepped = LocalSolver().Solve({.scene = ExactScene(), .history_intervals = 4});
  ASSERT_TRUE(stepped.ok()) << stepped.status();
  EXPECT_EQ(stepped->outcome.history, listed.history);
}

TEST(LocalSolverTest, AHistoryHasEitherImpulsesOrIntervals) {
  const auto refused = [](const SolveRequest& request) { return ViolationsOf(LocalSolver().Solve(request).status()); };
  EXPECT_THAT(refused({.scene = ExactScene(), .history_at_n_s = {0.0}, .history_intervals = 2}),
              ElementsAre(Violation{"history_at_n_s", "has 1 entry: must be empty, with history_intervals"}));
  EXPECT_THAT(refused({.scene = ExactScene(), .history_intervals = -1}),
              ElementsAre(Violation{"history_intervals", "= -1: must be in [0, 65535]"}));
  EXPECT_THAT(refused({.scene = ExactScene(), .history_intervals = 65536}),
              ElementsAre(Violation{"history_intervals", "= 65536: must be in [0, 65535]"}));
}

// A tangential spring changes the tangential impulse of a ball, whose normal motion it leaves alone.
TEST(LocalSolverTest, BoundsOfATangentialSpringAreRefused) {
  Scene ball = ExactScene();
  ball.system = PlanarContact{3.5, 0.0, 1.0, 2.0, -3.0};
  ball.restitution = std::monostate();
  EXPECT_TRUE(LocalSolver().Bounds({.scene = ball}).ok());
  ball.compliance = {.tangential_ratio_squared = 1.5, .normal = {}};
  EXPECT_THAT(ViolationsOf(LocalSolver().Bounds({.scene = ball}).status()),
              ElementsAre(Violation{"compliance.tangential_ratio_squared",
                                    "is set: must not be, for bounds of a rigid contact"}));
}

// At the larger tolerance the plan leaves the compliance out, and slip in space follows a straight line.
TEST(LocalSolverTest, WhichScenesHaveAHistoryDoesNotDependOnTheTolerance) {
  Scene soft = ExactScene();
  soft.restitution = EnergeticCoefficient{0.5};
  soft.compliance = {.tangential_ratio_squared = 1.0, .normal = {}};
  Scene in_space = ExactScene();
  in_space.system = SpatialContact{{2.0, 0.0, 0.0, 2.0, 0.0, 1.0}, {30.0, 18.0}, -1.0};
  for (const double tolerance : {0.0, 0.1}) {
    const auto refused = [&](const Scene& scene) {
      return ViolationsOf(
          LocalSolver()
              .Solve({.scene = scene, .history_at_n_s = {0.0, 0.0}, .demand = {.relative_tolerance = tolerance}})
              .status());
    };
    EXPECT_THAT(refused(soft), ElementsAre(Violation{"history_at_n_s",
                                                     "has 2 entries: must be empty for a contact with tangential "
                                                     "compliance"}));
    EXPECT_THAT(refused(in_space),
                ElementsAre(Violation{"history_at_n_s", "has 2 entries: must be empty for a system in space"}));
  }
}

// ---- Bounds ----

TEST(LocalSolverTest, BoundsNeedNoRestitutionAndAddTheNearlyVerticalForms) {
  const auto response = LocalSolver().Bounds({.scene = ExactScene(std::monostate())});
  ASSERT_TRUE(response.ok()) << response.status();
  EXPECT_EQ(response->engine, ThisEngine());
  EXPECT_EQ(response->bounds.slope_ratio, 0.5);
  EXPECT_EQ(response->bounds.sharp, pendulum::SolveBounds(pendulum::MakeProblem(ExactScene(std::monostate()))).sharp);
  ASSERT_TRUE(response->bounds.nearly_vertical.has_value());
  EXPECT_FALSE(response->bounds.nearly_vertical->coefficients.has_value());
}

TEST(LocalSolverTest, BoundsOfASceneWithRestitutionAddItsFirstOrderCoefficients) {
  const auto response = LocalSolver().Bounds({.scene = ExactScene(EnergeticCoefficient{0.5})});
  ASSERT_TRUE(response.ok()) << response.status();
  EXPECT_TRUE(response->bounds.nearly_vertical->coefficients.has_value());
}

TEST(LocalSolverTest, BoundsOfALockedPendulumHaveNoNearlyVerticalForms) {
  Scene scene = ExactScene();
  scene.friction.kinetic_coefficient = 0.75;
  const auto response = LocalSolver().Bounds({.scene = scene});
  ASSERT_TRUE(response.ok()) << response.status();
  EXPECT_EQ(response->bounds.regime, Regime::kLocked);
  EXPECT_FALSE(response->bounds.nearly_vertical.has_value());
}

TEST(LocalSolverTest, BoundsOfABadSceneListItsViolations) {
  Scene scene = ExactScene(NewtonCoefficient{-1.0});
  PendulumOf(scene).inertia_kg_m2 = -1.0;
  EXPECT_EQ(ViolationsOf(LocalSolver().Bounds({.scene = scene}).status()).size(), 2U);
}

TEST(LocalSolverTest, ABoundAboveTheLargestDoubleIsNamed) {
  Scene scene = ExactScene();
  PendulumOf(scene).inertia_kg_m2 = 1e308;
  const absl::Status status = LocalSolver().Bounds({.scene = scene}).status();
  EXPECT_EQ(status.code(), absl::StatusCode::kOutOfRange);
  EXPECT_THAT(std::string(status.message()), HasSubstr("bounds.sharp.normal_total_n_s.upper"));
}

// ---- Sweep ----

SweepRequest ManyPoints(int64_t count) {
  return {.grid = {.scene = ExactScene(), .axes = {{"pendulum.b_m", Linspace{-2.0, 2.0, count}}}},
          .columns = {"coefficients.newton", "energy_change_j"}};
}

TEST(LocalSolverTest, SweepStreamsEveryPointOnceInOrderAndEndsWithTheSummary) {
  SweepRequest request = ManyPoints(200'000);
  request.with_regime = true;
  int64_t next = 0;
  bool ended = false;
  for (const absl::StatusOr<SweepChunk>& chunk : LocalSolver().Sweep(request)) {
    ASSERT_TRUE(chunk.ok()) << chunk.status();
    ASSERT_FALSE(ended);
    EXPECT_EQ(chunk->first_index, next);
    EXPECT_EQ(chunk->values.size(), static_cast<size_t>(2 * chunk->count));
    EXPECT_EQ(chunk->regimes.size(), static_cast<size_t>(chunk->count));
    next += chunk->count;
    EXPECT_EQ(chunk->points_done, next);
    EXPECT_EQ(chunk->points_total, 200'000);
    EXPECT_EQ(chunk->engine, ThisEngine());
    ended = chunk->summary.has_value();
    if (ended) {
      EXPECT_EQ(chunk->summary->points, 200'000);
    }
  }
  EXPECT_TRUE(ended);
  EXPECT_EQ(next, 200'000);
}

TEST(LocalSolverTest, SweepSendsRegimesOnlyWhereAsked) {
  for (const absl::StatusOr<SweepChunk>& chunk : LocalSolver().Sweep(ManyPoints(3))) {
    ASSERT_TRUE(chunk.ok());
    EXPECT_THAT(chunk->regimes, IsEmpty());
  }
}

TEST(LocalSolverTest, AnEmptySweepIsOneChunkWithASummary) {
  SweepRequest request = ManyPoints(3);
  request.end_index = 0;
  int chunks = 0;
  for (const absl::StatusOr<SweepChunk>& chunk : LocalSolver().Sweep(request)) {
    ASSERT_TRUE(chunk.ok());
    EXPECT_EQ(chunk->count, 0);
    EXPECT_EQ(chunk->summary, SweepSummary());
    ++chunks;
  }
  EXPECT_EQ(chunks, 1);
}

TEST(LocalSolverTest, AnInvalidSweepIsAStreamOfOneError) {
  SweepRequest request = ManyPoints(3);
  request.columns.clear();
  int elements = 0;
  for (const absl::StatusOr<SweepChunk>& chunk : LocalSolver().Sweep(request)) {
    EXPECT_EQ(chunk.status().code(), absl::StatusCode::kInvalidArgument);
    ++elements;
  }
  EXPECT_EQ(elements, 1);
}

TEST(LocalSolverTest, AStoppedSweepEndsWithCancelled) {
  std::stop_source source;
  int elements = 0;
  absl::Status last;
  for (const absl::StatusOr<SweepChunk>& chunk :
       LocalSolver().Sweep(ManyPoints(1'000'000'000), {.stop = source.get_token()})) {
    last = chunk.status();
    if (++elements == 2) source.request_stop();
    ASSERT_LE(elements, 3);
  }
  EXPECT_EQ(elements, 3);
  EXPECT_EQ(last.code(), absl::StatusCode::kCancelled);
}

TEST(LocalSolverTest, ASweepEndsSoonAfterItsOptionsSaySo) {
  int64_t looks = 0;
  int64_t points = 0;
  absl::Status last;
  const CallOptions options = {.is_stopped = [&looks] { return ++looks > 3; }};
  for (const absl::StatusOr<SweepChunk>& chunk : LocalSolver().Sweep(ManyPoints(1'000'000'000), options)) {
    last = chunk.status();
    if (chunk.ok()) points += chunk->count;
  }
  EXPECT_EQ(last.code(), absl::StatusCode::kCancelled);
  EXPECT_LT(points, 1'000'000'000);
}

TEST(LocalSolverTest, TheStreamOutlivesTheRequestAndTheSolver) {
  SweepStream stream = [] {
    const SweepRequest request = ManyPoints(5'000);
    return LocalSolver().Sweep(request);
  }();
  int64_t points = 0;
  for (const absl::StatusOr<SweepChunk>& chunk : stream) {
    ASSERT_TRUE(chunk.ok());
    points += chunk->count;
  }
  EXPECT_EQ(points, 5'000);
}

// ---- Engine ----

TEST(EngineTest, FingerprintIsTheSameAtEveryCall) {
  EXPECT_EQ(ThisEngine().fingerprint, ThisEngine().fingerprint);
  EXPECT_THAT(ThisEngine().fingerprint, testing::MatchesRegex("[0-9a-f]+"));
}

TEST(ColumnTest, EveryColumnIsKnownByItsNameAndNoOther) {
  for (const std::string& name : PendulumColumns()) {
    EXPECT_NE(SceneLanes::Make(ExactScene(), {name}, {}), nullptr) << name;
  }
  for (const char* name : {"", "coefficients", "coefficients.newton ", "Coefficients.newton", "work.residual_j"}) {
    EXPECT_EQ(SceneLanes::Make(ExactScene(), {name}, {}), nullptr) << name;
  }
}

TEST(LocalSolverTest, ABatchOfAuditsHasAtMost8192Rows) {
  AuditBatchRequest request = {.scene = {.system = PlanarContact{}}, .columns = {}};
  request.columns.tangential_after_m_s = {0.5};
  request.columns.normal_after_m_s.assign(8193, 0.5);
  EXPECT_THAT(ViolationsOf(LocalSolver().AuditBatch(request).status()),
              testing::Contains(Violation{"columns", "has 8193 rows: must have at most 8192 in one call"}));
}

TEST(LocalSolverTest, BoundsEndOnceNobodyWaitsForThem) {
  const Scene scene = {.system = PlanarBody{1.0, 0.1, 0.2, -0.3, 1.0, -2.0, 0.5},
                       .friction = {.kinetic_coefficient = 0.5}};
  const BoundsRequest request = {.scene = scene,
                                 .ranges = {{"planar_body.offset_t_m", 0.1, 0.3},
                                            {"planar_body.offset_n_m", -0.4, -0.2},
                                            {"planar_body.rate_rad_s", 0.25, 0.75}}};
  int looks = 0;
  const CallOptions one_look = {.is_stopped = [&looks] { return ++looks > 1; }};
  EXPECT_EQ(LocalSolver().Bounds(request, one_look).status().code(), absl::StatusCode::kCancelled);
  EXPECT_LE(looks, 5);  // It asks before the search, within it, and for the reason why it ended.
  const CallOptions no_stop = {.is_stopped = [] { return false; }};
  EXPECT_EQ(LocalSolver().Bounds(request, no_stop)->enclosure, LocalSolver().Bounds(request)->enclosure);
}

}  // namespace
}  // namespace ricochet
