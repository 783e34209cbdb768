// Sweeps that other threads help have the bits of those that nobody helps, hold little, and end soon.

#include <gtest/gtest.h>

#include <atomic>
#include <bit>
#include <chrono>
#include <cstdint>
#include <memory>
#include <random>
#include <stdexcept>
#include <stop_token>
#include <thread>
#include <vector>

#include "core/engine/sweep_run.h"
#include "core/rows/column.h"
#include "ricochet/solver.h"
#include "tests/support/processes/counted_threads.h"
#include "tests/support/scenes/system_scenes.h"

namespace ricochet {
namespace {

using std::chrono::milliseconds;
using std::chrono::steady_clock;

// A sweep of a system with points of several regimes and bad ones.
SweepRequest Frictions(const System& system, int64_t count) {
  const Scene scene = With(system);
  return {.grid = {.scene = scene,
                   .axes = {{"friction.kinetic_coefficient", Linspace{-0.01, 1.5, count}},
                            {"restitution.energetic", ListValues{{0.0, 0.5, 1.0}}}}},
          .columns = Columns(scene),
          .with_regime = true};
}

System OnePendulum() { return Pendulum{.inertia_kg_m2 = 1.0, .a_m = 0.5, .b_m = 0.6, .omega_minus_rad_s = -1.0}; }

// Every system; for the pendulum, with the columns that its SIMD lanes give and with all of them.
std::vector<SweepRequest> Requests() {
  std::vector<SweepRequest> requests;
  for (const System& system : Systems()) requests.push_back(Frictions(system, 700));
  requests.push_back(Frictions(OnePendulum(), 50'000));
  requests.push_back(Frictions(OnePendulum(), 700));
  requests[requests.size() - 2].columns = {"coefficients.newton", "energy_change_j"};
  return requests;
}

struct Points {
  std::vector<std::vector<uint64_t>> columns;
  std::vector<Regime> regimes;
  SweepSummary summary;
  friend bool operator==(const Points&, const Points&) = default;
};

// Reads a run to its end; `is_enough` cuts its chunks.
Points ReadAll(const SweepRequest& request, const std::shared_ptr<Helpers>& helpers,
               absl::FunctionRef<bool()> is_enough) {
  Points points;
  points.columns.resize(request.columns.size());
  absl::StatusOr<SweepRun> run = SweepRun::Make(request, helpers);
  EXPECT_TRUE(run.ok()) << run.status();
  int64_t next = 0;
  while (run.ok() && !run->ended()) {
    const absl::StatusOr<SweepChunk> chunk = run->NextChunk([] { return false; }, is_enough);
    EXPECT_TRUE(chunk.ok()) << chunk.status();
    if (!chunk.ok()) break;
    EXPECT_EQ(chunk->first_index, next);
    EXPECT_EQ(chunk->points_done, next + chunk->count);
    EXPECT_EQ(chunk->tallies.points, chunk->points_done);
    EXPECT_LE(chunk->values.size() * sizeof(double), size_t{512} << 10);
    for (size_t c = 0; c < request.columns.size(); ++c) {
      for (int64_t i = 0; i < chunk->count; ++i) {
        const double value = chunk->values[c * static_cast<size_t>(chunk->count) + static_cast<size_t>(i)];
        points.columns[c].push_back(std::bit_cast<uint64_t>(value));
      }
    }
    points.regimes.insert(points.regimes.end(), chunk->regimes.begin(), chunk->regimes.end());
    next += chunk->count;
    if (chunk->summary.has_value()) points.summary = *chunk->summary;
  }
  return points;
}

Points ReadAll(const SweepRequest& request, const std::shared_ptr<Helpers>& helpers) {
  return ReadAll(request, helpers, [] { return false; });
}

TEST(SweepThreadsTest, PointsHaveTheSameBitsWhateverTheNumberOfThreads) {
  int helped = 0;
  for (const SweepRequest& request : Requests()) {
    const Points alone = ReadAll(request, nullptr);
    for (const int helpers : {1, 7}) {
      const auto threads = std::make_shared<CountedThreads>(helpers);
      EXPECT_EQ(ReadAll(request, threads), alone) << request.grid.scene.system.index() << " with " << helpers;
      helped += threads->started();
    }
  }
  EXPECT_GT(helped, 10);
}

TEST(SweepThreadsTest, PointsHaveTheSameBitsWhereverChunksAreCut) {
  std::mt19937_64 random(1);
  for (const SweepRequest& request : Requests()) {
    const Points alone = ReadAll(request, nullptr);
    const auto threads = std::make_shared<CountedThreads>(3);
    EXPECT_EQ(ReadAll(request, threads, [&random] { return random() % 4 == 0; }), alone);
    EXPECT_EQ(ReadAll(request, threads, [] { return true; }), alone);
  }
}

TEST(SweepThreadsTest, PointsHaveTheSameBitsIfHelpersGiveWayAfterEachBlock) {
  const SweepRequest request = Frictions(Contact(), 10'000);
  const auto threads = std::make_shared<CountedThreads>(2, true);
  EXPECT_EQ(ReadAll(request, threads), ReadAll(request, nullptr));
  EXPECT_GT(threads->started(), 2);
}

TEST(SweepThreadsTest, ASweepThatEndsAtOnceWakesNobody) {
  const auto threads = std::make_shared<CountedThreads>(2);
  ReadAll(Frictions(OnePendulum(), 1), threads);
  EXPECT_EQ(threads->started(), 0);
}

SweepRequest Endless() {
  SweepRequest request = Frictions(ContactInSpace(), 1);
  request.grid.axes[0].values = Linspace{0.1, 1.5, 1'000'000'000};
  return request;
}

bool Never() { return false; }

// Waits until a condition holds, which it does long before the end of the wait.
template <typename Condition>
bool Comes(Condition condition) {
  const auto end = steady_clock::now() + std::chrono::seconds(60);
  while (!condition() && steady_clock::now() < end) std::this_thread::sleep_for(milliseconds(1));
  return condition();
}

TEST(SweepThreadsTest, HelpersComputeNoMoreThanOneChunkAheadOfACallerWhoIsAway) {
  const auto threads = std::make_shared<CountedThreads>(3);
  SweepRequest request = Endless();
  request.columns = {"energy_change_j", "coefficients.newton", "coefficients.poisson", "coefficients.energetic"};
  absl::StatusOr<SweepRun> run = SweepRun::Make(request, threads);
  ASSERT_TRUE(run.ok());
  int64_t taken = 0;
  while (threads->started() == 0) {
    const absl::StatusOr<SweepChunk> chunk = run->NextChunk(Never);
    ASSERT_TRUE(chunk.ok());
    taken = chunk->points_done;
  }
  EXPECT_TRUE(Comes([&] { return threads->running() == 0; }));
  const int64_t ahead = run->points_done() - taken;
  EXPECT_GT(ahead, 0);
  EXPECT_LE(ahead * 4 * static_cast<int64_t>(sizeof(double)), int64_t{512} << 10);
}

TEST(SweepThreadsTest, AStreamThatIsDestroyedInTheMiddleLeavesNoHelperBehind) {
  const auto threads = std::make_shared<CountedThreads>(3);
  {
    SweepStream stream = LocalSolver().Sweep(Endless(), {.helpers = threads});
    auto chunk = stream.begin();
    while (threads->started() == 0) {
      ++chunk;
      ASSERT_TRUE(chunk->ok());
    }
  }
  EXPECT_TRUE(Comes([&] { return threads->running() == 0; }));
}

TEST(SweepThreadsTest, AfterAStopNoHelperGoesOn) {
  const auto threads = std::make_shared<CountedThreads>(2);
  absl::StatusOr<SweepRun> run = SweepRun::Make(Endless(), threads);
  ASSERT_TRUE(run.ok());
  while (threads->started() == 0) ASSERT_TRUE(run->NextChunk(Never).ok());
  const absl::StatusOr<SweepChunk> stopped = run->NextChunk([] { return true; });
  EXPECT_EQ(stopped.status().code(), absl::StatusCode::kCancelled);
  EXPECT_TRUE(Comes([&] { return threads->running() == 0; }));
  const int64_t done = run->points_done();
  std::this_thread::sleep_for(milliseconds(20));
  EXPECT_EQ(run->points_done(), done);
}

// The stop is asked for by a thread that is not the stream's, while the caller reads and while it is away.
TEST(SweepThreadsTest, AStopEndsASweepOfManyThreads) {
  const LocalSolver solver(Limits::None(), 4);
  std::stop_source source;
  std::jthread stopper([&] {
    std::this_thread::sleep_for(milliseconds(50));
    source.request_stop();
  });
  absl::Status last;
  for (const absl::StatusOr<SweepChunk>& chunk : solver.Sweep(Endless(), {.stop = source.get_token()})) {
    last = chunk.status();
  }
  EXPECT_EQ(last.code(), absl::StatusCode::kCancelled) << last;
}

TEST(SweepThreadsTest, ADeadlineEndsASweepOfManyThreads) {
  const LocalSolver solver(Limits::None(), 4);
  absl::Status last;
  for (const absl::StatusOr<SweepChunk>& chunk :
       solver.Sweep(Endless(), {.deadline = steady_clock::now() + milliseconds(50)})) {
    last = chunk.status();
  }
  EXPECT_EQ(last.code(), absl::StatusCode::kDeadlineExceeded) << last;
}

// The options say that the engine asks is_stopped on the thread of the call.
TEST(SweepThreadsTest, TheOptionsAreAskedOnTheThreadOfTheCallAlone) {
  const LocalSolver solver(Limits::None(), 3);
  const std::thread::id caller = std::this_thread::get_id();
  std::atomic<bool> asked_elsewhere = false;
  int asked = 0;
  const auto end = steady_clock::now() + milliseconds(50);
  const CallOptions options = {.is_stopped = [&] {
    if (std::this_thread::get_id() != caller) asked_elsewhere = true;
    ++asked;
    return steady_clock::now() > end;
  }};
  for (const absl::StatusOr<SweepChunk>& chunk : solver.Sweep(Endless(), options)) {
    EXPECT_TRUE(chunk.ok() || absl::IsCancelled(chunk.status()));
  }
  EXPECT_GT(asked, 0);
  EXPECT_FALSE(asked_elsewhere);
}

// Copies of a solver share its threads, and several streams compete for them.
TEST(SweepThreadsTest, WhatKeepsAHelperFromStartingReachesTheCaller) {
  struct NoThreads final : Helpers {
    int most() const override { return 2; }
    bool Start(Help /*help*/) override { throw std::runtime_error("no thread"); }
  };
  SweepStream stream =
      LocalSolver().Sweep(Frictions(OnePendulum(), 1'000'000), {.helpers = std::make_shared<NoThreads>()});
  const auto read = [&stream] {
    for (const auto& chunk : stream) ASSERT_TRUE(chunk.ok());
  };
  EXPECT_THROW(read(), std::runtime_error);
}

TEST(SweepThreadsTest, ManySweepsAtOnceHaveTheSameBits) {
  SweepRequest request = Frictions(Contact(), 4'000);
  request.columns = {"energy_change_j"};
  const auto energies = [&request](const LocalSolver& solver) {
    std::vector<uint64_t> bits;
    for (const absl::StatusOr<SweepChunk>& chunk : solver.Sweep(request)) {
      EXPECT_TRUE(chunk.ok());
      for (const double value : chunk->values) bits.push_back(std::bit_cast<uint64_t>(value));
    }
    return bits;
  };
  const std::vector<uint64_t> alone = energies(LocalSolver(Limits::None(), 1));
  const LocalSolver solver(Limits::None(), 3);
  std::vector<std::jthread> callers;
  std::atomic<int> same = 0;
  for (int i = 0; i < 4; ++i) {
    callers.emplace_back([&, copy = solver] {
      if (energies(copy) == alone) ++same;
    });
  }
  callers.clear();
  EXPECT_EQ(same, 4);
}

}  // namespace
}  // namespace ricochet
