// The promises of Solver::Cost, for LocalSolver and Client: times differ, everything else is equal.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <stop_token>
#include <string>
#include <thread>
#include <vector>

#include "ricochet/engine_info.h"
#include "tests/contract/solvers.h"
#include "tests/support/scenes/multi_contact_scenes.h"
#include "tests/support/scenes/system_scenes.h"

namespace ricochet {
namespace {

using std::chrono::milliseconds;
using std::chrono::steady_clock;
using testing::ElementsAre;

class CostContract : public testing::TestWithParam<std::string> {
 protected:
  const Solver& solver() const { return GetParam() == "Local" ? Local() : Remote(); }
};

INSTANTIATE_TEST_SUITE_P(Solvers, CostContract, testing::Values("Local", "Remote"),
                         [](const auto& parameter) { return parameter.param; });

using Chunks = std::vector<absl::StatusOr<CostChunk>>;

Chunks Read(CostStream stream) {
  Chunks chunks;
  for (absl::StatusOr<CostChunk>& chunk : stream) chunks.push_back(std::move(chunk));
  return chunks;
}

// One sample makes a test short.
CostRequest Request(const Scene& scene) { return {.scene = scene, .time_limit_s = 30.0, .samples = 1}; }

// Sets aside the times of a chunk, and what follows from them.
CostChunk WithoutTimes(CostChunk chunk) {
  for (CostRow& row : chunk.rows) {
    row.solve.reset();
    row.batch.reset();
    row.batch_in_lanes = false;
    row.note.clear();  // It may say that there was no time for a batch.
  }
  if (chunk.summary.has_value()) {
    chunk.summary->front.clear();
    chunk.summary->elapsed_s = 0.0;
  }
  return chunk;
}

std::vector<CostChunk> WithoutTimes(const Chunks& chunks) {
  std::vector<CostChunk> bare;
  for (const auto& chunk : chunks) bare.push_back(WithoutTimes(chunk.value()));
  return bare;
}

TEST_P(CostContract, BeginsWithNoRowAndEndsWithTheSummary) {
  int64_t rows = 0;
  bool first = true;
  bool summarised = false;
  for (const auto& chunk : solver().Cost(Request(PaperScene()))) {
    ASSERT_TRUE(chunk.ok()) << chunk.status();
    EXPECT_FALSE(summarised);
    EXPECT_EQ(chunk->rows.empty(), first);
    EXPECT_EQ(chunk->first_row, rows);
    rows += static_cast<int64_t>(chunk->rows.size());
    EXPECT_EQ(chunk->rows_done, rows);
    EXPECT_GT(chunk->rows_total, 0);
    EXPECT_EQ(chunk->engine, ThisEngine());
    first = false;
    summarised = chunk->summary.has_value();
    EXPECT_EQ(summarised, rows == chunk->rows_total);
  }
  EXPECT_TRUE(summarised);
}

TEST_P(CostContract, AnswersThePendulumWithinItsTimeLimit) {
  const auto start = steady_clock::now();
  const Chunks chunks = Read(solver().Cost({.scene = PaperScene(), .samples = kMostCostSamples}));
  ASSERT_TRUE(chunks.back().ok()) << chunks.back().status();
  // So many samples would take nearly a minute. The limit is 3 s, and the rest is for a busy machine.
  EXPECT_LT(steady_clock::now() - start, std::chrono::seconds(30));
  EXPECT_EQ(chunks.back()->summary->deceived, 0);
  EXPECT_FALSE(chunks.back()->summary->front.empty());
}

TEST_P(CostContract, GivesTheRowsOfTheOtherSolver) {
  for (const System& system : {System(Contact()), System(ContactInSpace()), System(Chain())}) {
    const Chunks one = Read(solver().Cost(Request(With(system))));
    const Chunks other = Read(Local().Cost(Request(With(system))));
    EXPECT_EQ(WithoutTimes(one), WithoutTimes(other));
  }
}

TEST_P(CostContract, GivesTheRowsOfTheOtherSolverForSeveralContacts) {
  const CostRequest request = {.time_limit_s = 30.0, .samples = 1, .multi_contact = FallingBlock(1.0, 0.5)};
  EXPECT_EQ(WithoutTimes(Read(solver().Cost(request))), WithoutTimes(Read(Local().Cost(request))));
}

TEST_P(CostContract, ABadRequestIsAStreamOfOneErrorWithEveryViolation) {
  CostRequest request = {.scene = PaperScene(), .time_limit_s = 0.0, .samples = 1002};
  request.scene.friction.kinetic_coefficient = -1.0;
  const Chunks chunks = Read(solver().Cost(request));
  ASSERT_EQ(chunks.size(), 1U);
  EXPECT_EQ(chunks[0].status().code(), absl::StatusCode::kInvalidArgument);
  EXPECT_THAT(ViolationsOf(chunks[0].status()),
              ElementsAre(Violation{"friction.kinetic_coefficient", "= -1: must be >= 0"},
                          Violation{"time_limit_s", "= 0: must be in [0.01, 60]"},
                          Violation{"samples", "= 1002: must be in [1, 1001]"}));
}

TEST_P(CostContract, AStopFromAnotherThreadEndsIt) {
  std::stop_source stop;
  CostStream stream =
      solver().Cost({.scene = PaperScene(), .time_limit_s = 60.0, .samples = 1001}, {.stop = stop.get_token()});
  Chunks chunks;
  for (absl::StatusOr<CostChunk>& chunk : stream) {
    chunks.push_back(std::move(chunk));
    if (chunks.size() == 2) std::jthread([&stop] { stop.request_stop(); }).join();
  }
  EXPECT_EQ(chunks.back().status().code(), absl::StatusCode::kCancelled) << chunks.back().status();
  // Rows that were on their way may still arrive, but not all.
  EXPECT_LT(chunks.size(), Read(solver().Cost(Request(PaperScene()))).size());
}

TEST_P(CostContract, EndsAtItsDeadline) {
  const Chunks chunks = Read(solver().Cost({.scene = PaperScene(), .time_limit_s = 60.0, .samples = 1001},
                                           {.deadline = steady_clock::now() + milliseconds(50)}));
  EXPECT_EQ(chunks.back().status().code(), absl::StatusCode::kDeadlineExceeded) << chunks.back().status();
}

TEST_P(CostContract, AStreamMayBeDroppedHalfRead) {
  const auto start = steady_clock::now();
  {
    CostStream stream = solver().Cost({.scene = PaperScene(), .time_limit_s = 60.0, .samples = 1001});
    EXPECT_TRUE((*stream.begin()).ok());
  }
  EXPECT_LT(steady_clock::now() - start, std::chrono::seconds(5));
  EXPECT_TRUE(solver().Solve({.scene = PaperScene(), .history_at_n_s = {}}).ok());
}

}  // namespace
}  // namespace ricochet
