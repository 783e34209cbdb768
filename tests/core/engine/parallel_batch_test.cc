// Batches that other threads help have the bits and the summary of those that nobody helps, and end soon.

#include "core/engine/parallel_batch.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <bit>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "core/rows/column.h"
#include "tests/support/processes/counted_threads.h"
#include "tests/support/processes/eventually.h"
#include "tests/support/scenes/system_scenes.h"

namespace ricochet {
namespace {

constexpr size_t kRows = 20'000;

// A batch with rows of several regimes and, every hundred rows, a bad one.
struct Batch {
  explicit Batch(const System& system, size_t rows = kRows) {
    setup.scene = With(system);
    setup.fields = {"friction.kinetic_coefficient", "restitution.energetic"};
    setup.columns = Columns(setup.scene);
    in.assign(2, std::vector<double>(rows));
    out.assign(setup.columns.size(), std::vector<double>(rows));
    regimes.resize(rows);
    statuses.resize(rows);
    for (size_t i = 0; i < rows; ++i) {
      in[0][i] = i % 100 == 99 ? -0.1 : 1.5 * static_cast<double>(i % 37) / 37.0;
      in[1][i] = static_cast<double>(i % 11) / 10.0;
    }
  }

  BatchRows Rows() {
    BatchRows rows = {
        .inputs = {}, .outputs = {}, .regimes = absl::MakeSpan(regimes), .statuses = absl::MakeSpan(statuses)};
    for (const auto& column : in) rows.inputs.emplace_back(column);
    for (auto& column : out) rows.outputs.push_back(absl::MakeSpan(column));
    return rows;
  }

  // All numbers of the answer.
  std::vector<uint64_t> Bits() const {
    std::vector<uint64_t> bits;
    for (const auto& column : out) {
      for (const double number : column) bits.push_back(std::bit_cast<uint64_t>(number));
    }
    for (const Regime regime : regimes) bits.push_back(static_cast<uint64_t>(regime));
    for (const RowStatus status : statuses) bits.push_back(static_cast<uint64_t>(status));
    return bits;
  }

  BatchSetup setup;
  std::vector<std::vector<double>> in, out;
  std::vector<Regime> regimes;
  std::vector<RowStatus> statuses;
};

TEST(ParallelBatchTest, RowsAndSummaryAreTheSameWhateverTheNumberOfThreads) {
  int helped = 0;
  for (const System& system : Systems()) {
    Batch alone(system);
    const auto run = ParallelBatch::Make(alone.setup, nullptr);
    ASSERT_TRUE(run.ok()) << run.status();
    const absl::StatusOr<BatchSummary> expected = (*run)->Solve(alone.Rows(), [] { return false; });
    ASSERT_TRUE(expected.ok());
    EXPECT_EQ(expected->bad_rows.size(), kMostBadRows);
    for (const int helpers : {1, 7}) {
      const auto threads = std::make_shared<CountedThreads>(helpers);
      const auto batch = ParallelBatch::Make(alone.setup, threads);
      ASSERT_TRUE(batch.ok());
      for (int i = 0; i < 2; ++i) {
        Batch together(system);
        const absl::StatusOr<BatchSummary> summary = (*batch)->Solve(together.Rows(), [] { return false; });
        ASSERT_TRUE(summary.ok());
        EXPECT_EQ(*summary, *expected) << system.index();
        EXPECT_EQ(together.Bits(), alone.Bits()) << system.index();
      }
      helped += threads->started();
    }
  }
  EXPECT_GT(helped, 0);
}

TEST(ParallelBatchTest, AShortBatchIsComputedByItsCallerAlone) {
  const auto threads = std::make_shared<CountedThreads>(3);
  Batch batch(Systems().back(), 4);
  const auto parallel = ParallelBatch::Make(batch.setup, threads);
  ASSERT_TRUE(parallel.ok());
  ASSERT_TRUE((*parallel)->Solve(batch.Rows(), [] { return false; }).ok());
  EXPECT_EQ(threads->started(), 0);
}

// A row that is followed in time takes a good part of a millisecond.
TEST(ParallelBatchTest, AFewRowsThatTakeLongAreShared) {
  const auto make = [] {
    Batch batch(PlanarContact{3.5, 0.3, 1.0, 1.0, -1.0}, 60);
    batch.setup.scene.compliance = Compliance{.normal = LinearSpring{1e6}};
    batch.setup.columns = {"contact_velocity_after.normal_m_s", "contact.duration_s"};
    batch.out.resize(batch.setup.columns.size());
    return batch;
  };
  Batch alone = make();
  const auto run = ParallelBatch::Make(alone.setup, nullptr);
  ASSERT_TRUE(run.ok()) << run.status();
  ASSERT_TRUE((*run)->Solve(alone.Rows(), [] { return false; }).ok());
  const auto threads = std::make_shared<CountedThreads>(3);
  Batch together = make();
  ASSERT_TRUE((*ParallelBatch::Make(together.setup, threads))->Solve(together.Rows(), [] { return false; }).ok());
  EXPECT_GT(threads->started(), 0);
  EXPECT_EQ(together.Bits(), alone.Bits());
}

TEST(ParallelBatchTest, AStopEndsHelpersToo) {
  const auto threads = std::make_shared<CountedThreads>(3);
  Batch batch(Systems().back());
  const auto parallel = ParallelBatch::Make(batch.setup, threads);
  ASSERT_TRUE(parallel.ok());
  const auto stopped = [&] { return threads->started() > 0; };
  EXPECT_EQ((*parallel)->Solve(batch.Rows(), stopped).status().code(), absl::StatusCode::kCancelled);
  EXPECT_TRUE(Eventually([&] { return threads->running() == 0; }));
}

TEST(ParallelBatchTest, ColumnsThatDoNotFitAreRefusedBeforeAnyRow) {
  Batch batch(Systems().back());
  const auto parallel = ParallelBatch::Make(batch.setup, nullptr);
  ASSERT_TRUE(parallel.ok());
  batch.in[1].pop_back();
  const absl::Status refused = (*parallel)->Solve(batch.Rows(), [] { return false; }).status();
  EXPECT_EQ(refused.code(), absl::StatusCode::kInvalidArgument);
  EXPECT_THAT(std::string(refused.message()), testing::HasSubstr("inputs[1]"));
}

}  // namespace
}  // namespace ricochet
