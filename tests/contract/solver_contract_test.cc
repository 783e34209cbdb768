// What every Solver promises (core/solver.h), asked of each.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <bit>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <stop_token>
#include <string>
#include <thread>
#include <vector>

#include "tests/contract/solvers.h"
#include "tests/support/system_scenes.h"

namespace ricochet {
namespace {

using testing::ElementsAre;
using testing::Field;

class SolverContract : public testing::TestWithParam<std::string> {
 protected:
  const Solver& solver() const { return GetParam() == "Local" ? Local() : Remote(); }
};

INSTANTIATE_TEST_SUITE_P(Solvers, SolverContract, testing::Values("Local", "Remote"),
                         [](const auto& parameter) { return parameter.param; });

SweepRequest FrictionSweep(int64_t count) {
  SweepRequest request;
  request.grid.scene = PaperScene();
  request.grid.axes = {{"friction.kinetic_coefficient", Linspace{0.0, 0.4, count}}};
  request.columns = {"coefficients.newton", "coefficients.poisson"};
  return request;
}

TEST_P(SolverContract, SolvesThePapersExample) {
  const auto response = solver().Solve({.scene = PaperScene(), .history_at_n_s = {}});
  ASSERT_TRUE(response.ok()) << response.status();
  EXPECT_EQ(response->outcome.regime, Regime::kRebound);
  EXPECT_NEAR(response->outcome.coefficients.newton, std::sqrt(0.5), 1e-15);
  EXPECT_NEAR(response->outcome.coefficients.poisson, std::sqrt(2.0), 1e-15);
  EXPECT_NEAR(response->outcome.coefficients.tangential, -0.0172, 5e-5);
}

TEST_P(SolverContract, SaysWhichEngineAnswered) {
  const auto response = solver().Solve({.scene = PaperScene(), .history_at_n_s = {}});
  ASSERT_TRUE(response.ok()) << response.status();
  EXPECT_EQ(response->engine, ThisEngine());
}

TEST_P(SolverContract, BoundsNeedNoRestitution) {
  Scene scene = PaperScene();
  scene.restitution = std::monostate();
  const auto response = solver().Bounds({.scene = scene});
  ASSERT_TRUE(response.ok()) << response.status();
  EXPECT_NEAR(response->bounds.sharp.newton.upper, std::sqrt(0.5), 1e-15);
  EXPECT_EQ(solver().Solve({.scene = scene, .history_at_n_s = {}}).status().code(), absl::StatusCode::kInvalidArgument);
}

TEST_P(SolverContract, BoundsHoldForEverySystem) {
  for (const System& system : Systems()) {
    const auto response = solver().Bounds({.scene = With(system)});
    ASSERT_TRUE(response.ok()) << response.status();
    EXPECT_EQ(response->bounds.sharp.energetic, (Range{0.0, 1.0}));
    EXPECT_EQ(response->bounds.energy_only.has_value(), !response->bounds.sampled);
    EXPECT_FALSE(response->enclosure.has_value());
  }
}

TEST_P(SolverContract, EnclosesAnUncertainScene) {
  const auto response =
      solver().Bounds({.scene = PaperScene(), .ranges = {{"friction.kinetic_coefficient", 0.09, 0.11}}});
  ASSERT_TRUE(response.ok()) << response.status();
  ASSERT_TRUE(response->enclosure.has_value());
  EXPECT_NEAR(response->enclosure->outer.newton.upper, std::sqrt(0.21 / 0.39), 1e-15);
  EXPECT_NEAR(response->enclosure->outer.poisson.upper, std::sqrt(0.41 / 0.19), 1e-15);
}

TEST_P(SolverContract, EnclosesUpToInfinityWhereFrictionMayLock) {
  const auto response =
      solver().Bounds({.scene = PaperScene(), .ranges = {{"friction.kinetic_coefficient", 0.1, 0.4}}});
  ASSERT_TRUE(response.ok()) << response.status();
  EXPECT_TRUE(std::isinf(response->enclosure->outer.poisson.upper));
}

TEST_P(SolverContract, RefusesRangesOfFieldsThatItCannotEnclose) {
  const absl::Status status =
      solver().Bounds({.scene = PaperScene(), .ranges = {{"restitution.energetic", 0.5, 0.6}}}).status();
  EXPECT_EQ(status.code(), absl::StatusCode::kInvalidArgument);
  EXPECT_THAT(ViolationsOf(status), ElementsAre(Field(&Violation::field, "ranges[0].path")));
}

TEST_P(SolverContract, ReportsEveryViolationOfAScene) {
  Scene scene = PaperScene();
  std::get<Pendulum>(scene.system).a_m = 0.0;
  scene.friction.kinetic_coefficient = -0.1;
  scene.restitution = EnergeticCoefficient{1.5};
  const absl::Status status = solver().Solve({.scene = scene, .history_at_n_s = {}}).status();
  EXPECT_EQ(status.code(), absl::StatusCode::kInvalidArgument);
  EXPECT_EQ(ReasonOf(status), ErrorReason::kInvalidRequest);
  EXPECT_THAT(ViolationsOf(status), ElementsAre(Violation{"pendulum.a_m", "= 0: must be > 0"},
                                                Violation{"friction.kinetic_coefficient", "= -0.1: must be >= 0"},
                                                Violation{"restitution.energetic", "= 1.5: must be in [0, 1]"}));
}

TEST_P(SolverContract, AnswersAnInadmissibleOutcomeUnlessAskedNotTo) {
  SolveRequest request{.scene = PaperScene(), .history_at_n_s = {}};
  request.scene.restitution = NewtonCoefficient{0.9};
  const auto response = solver().Solve(request);
  ASSERT_TRUE(response.ok()) << response.status();
  EXPECT_FALSE(response->outcome.admissible);
  request.inadmissible_is_error = true;
  const absl::Status status = solver().Solve(request).status();
  EXPECT_EQ(status.code(), absl::StatusCode::kFailedPrecondition);
  EXPECT_EQ(ReasonOf(status), ErrorReason::kInadmissibleOutcome);
}

TEST_P(SolverContract, RefusesAResultAboveTheLargestDouble) {
  Scene scene = PaperScene();
  std::get<Pendulum>(scene.system).inertia_kg_m2 = 1e308;
  std::get<Pendulum>(scene.system).omega_minus_rad_s = -1e10;
  const absl::Status status = solver().Solve({.scene = scene, .history_at_n_s = {}}).status();
  EXPECT_EQ(status.code(), absl::StatusCode::kOutOfRange);
  EXPECT_EQ(ReasonOf(status), ErrorReason::kOutputOverflow);
}

TEST_P(SolverContract, AnswersTheLongestHistory) {
  SolveRequest request{.scene = PaperScene(), .history_at_n_s = std::vector<double>(65536, 1.0)};
  const auto response = solver().Solve(request);
  ASSERT_TRUE(response.ok()) << response.status();
  EXPECT_EQ(response->outcome.history.size(), 65536);
  EXPECT_EQ(response->outcome.history.back(), response->outcome.history.front());
}

TEST_P(SolverContract, RefusesAHistoryOutsideTheImpact) {
  const absl::Status status = solver().Solve({.scene = PaperScene(), .history_at_n_s = {0.0, 100.0}}).status();
  ASSERT_EQ(status.code(), absl::StatusCode::kInvalidArgument);
  EXPECT_THAT(ViolationsOf(status), ElementsAre(Field(&Violation::field, "history_at_n_s[1]")));
}

TEST_P(SolverContract, SweepsEveryPointOnceInOrderAndEndsWithTheSummary) {
  constexpr int64_t kPoints = 200'001;
  int64_t next = 0;
  bool summarised = false;
  for (const auto& chunk : solver().Sweep(FrictionSweep(kPoints))) {
    ASSERT_TRUE(chunk.ok()) << chunk.status();
    EXPECT_FALSE(summarised);
    EXPECT_EQ(chunk->first_index, next);
    EXPECT_EQ(chunk->values.size(), static_cast<size_t>(2 * chunk->count));
    EXPECT_TRUE(chunk->regimes.empty());
    next += chunk->count;
    EXPECT_EQ(chunk->points_done, next);
    EXPECT_EQ(chunk->points_total, kPoints);
    summarised = chunk->summary.has_value();
    EXPECT_EQ(chunk->summary.value_or(SweepSummary{.points = kPoints}).points, kPoints);
  }
  EXPECT_TRUE(summarised);
  EXPECT_EQ(next, kPoints);
}

TEST_P(SolverContract, SweepsThePointsOfASolve) {
  SweepRequest request = FrictionSweep(5);
  const auto chunks = Collect(solver().Sweep(request));
  ASSERT_TRUE(chunks.front().ok()) << chunks.front().status();
  for (int64_t i = 0; i < 5; ++i) {
    Scene scene = PaperScene();
    scene.friction.kinetic_coefficient = AxisValue(request.grid.axes[0], i);
    const auto response = solver().Solve({.scene = scene, .history_at_n_s = {}});
    ASSERT_TRUE(response.ok()) << response.status();
    EXPECT_EQ(chunks.front()->values[static_cast<size_t>(i)], response->outcome.coefficients.newton);
  }
}

TEST_P(SolverContract, GivesABadPointQuietNaNAndGoesOn) {
  SweepRequest request = FrictionSweep(3);
  request.grid.axes[0].values = ListValues{{0.1, -1.0, 0.2}};
  request.with_regime = true;
  const auto chunks = Collect(solver().Sweep(request));
  ASSERT_EQ(chunks.size(), 1);
  ASSERT_TRUE(chunks[0].ok()) << chunks[0].status();
  EXPECT_THAT(chunks[0]->regimes, ElementsAre(Regime::kRebound, Regime::kInvalid, Regime::kRebound));
  EXPECT_TRUE(std::isnan(chunks[0]->values[1]));
  EXPECT_TRUE((std::bit_cast<uint64_t>(chunks[0]->values[1]) & (uint64_t{1} << 51)) != 0) << "a signalling NaN";
  EXPECT_EQ(chunks[0]->summary->by_regime[static_cast<size_t>(Regime::kInvalid)], (Tally{1, 1}));
}

TEST_P(SolverContract, AnEmptyRangeIsOneEmptyChunkWithItsSummary) {
  SweepRequest request = FrictionSweep(10);
  request.first_index = 10;
  const auto chunks = Collect(solver().Sweep(request));
  ASSERT_EQ(chunks.size(), 1);
  ASSERT_TRUE(chunks[0].ok()) << chunks[0].status();
  EXPECT_EQ(chunks[0]->count, 0);
  EXPECT_EQ(chunks[0]->summary->points, 0);
}

TEST_P(SolverContract, ABadGridIsAStreamOfOneErrorWithEveryViolation) {
  SweepRequest request = FrictionSweep(0);
  request.grid.axes.push_back({"pendulum.mass_kg", ListValues{{1.0}}});
  request.columns = {"coefficients.elastic"};
  const auto chunks = Collect(solver().Sweep(request));
  ASSERT_EQ(chunks.size(), 1);
  const absl::Status& status = chunks[0].status();
  EXPECT_EQ(status.code(), absl::StatusCode::kInvalidArgument);
  EXPECT_THAT(ViolationsOf(status), testing::UnorderedElementsAre(Field(&Violation::field, "axes[0].linspace.count"),
                                                                  Field(&Violation::field, "axes[1].path"),
                                                                  Field(&Violation::field, "columns[0]")));
}

TEST_P(SolverContract, AStoppedSweepEndsWithCancelled) {
  std::stop_source stop;
  absl::Status last;
  int64_t points = 0;
  for (const auto& chunk : solver().Sweep(FrictionSweep(1'000'000'000), stop.get_token())) {
    last = chunk.status();
    if (chunk.ok()) points = chunk->points_done;
    stop.request_stop();
  }
  EXPECT_EQ(last.code(), absl::StatusCode::kCancelled) << last;
  EXPECT_LT(points, 1'000'000);
}

TEST_P(SolverContract, ASweepStoppedFromAnotherThreadEndsSoon) {
  std::jthread stopper;
  std::stop_source stop;
  SweepStream stream = solver().Sweep(FrictionSweep(10'000'000'000), stop.get_token());
  stopper = std::jthread([&stop] {
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    stop.request_stop();
  });
  absl::Status last;
  for (const auto& chunk : stream) last = chunk.status();
  EXPECT_EQ(last.code(), absl::StatusCode::kCancelled) << last;
}

TEST_P(SolverContract, ASweepStoppedBeforeItStartsGivesNoPoint) {
  std::stop_source stop;
  stop.request_stop();
  const auto chunks = Collect(solver().Sweep(FrictionSweep(1000), stop.get_token()));
  ASSERT_EQ(chunks.size(), 1);
  EXPECT_EQ(chunks[0].status().code(), absl::StatusCode::kCancelled);
}

TEST_P(SolverContract, AStreamMayBeDroppedHalfRead) {
  const auto start = std::chrono::steady_clock::now();
  for (int i = 0; i < 10; ++i) {
    SweepStream stream = solver().Sweep(FrictionSweep(1'000'000'000));
    EXPECT_TRUE((*stream.begin()).ok());
  }
  { const SweepStream unread = solver().Sweep(FrictionSweep(1'000'000'000)); }
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(10));
  EXPECT_TRUE(solver().Solve({.scene = PaperScene(), .history_at_n_s = {}}).ok());
}

TEST_P(SolverContract, AnswersManyThreadsAtOnce) {
  std::atomic<int> right = 0;
  {
    std::vector<std::jthread> threads;
    for (int t = 0; t < 8; ++t) {
      threads.emplace_back([this, &right] {
        const auto response = solver().Solve({.scene = PaperScene(), .history_at_n_s = {}});
        const auto chunks = Collect(solver().Sweep(FrictionSweep(20'000)));
        if (response.ok() && chunks.back().ok() && chunks.back()->summary.has_value()) ++right;
      });
    }
  }
  EXPECT_EQ(right, 8);
}

}  // namespace
}  // namespace ricochet
