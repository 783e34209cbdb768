// SweepBuffer: points leave once, in order, in whatever order their blocks are computed.

#include "core/engine/sweep_buffer.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <optional>
#include <random>
#include <vector>

namespace ricochet {
namespace {

using testing::ElementsAre;
using Block = SweepBuffer::Block;

// Computes the first `count` points of a block: the value of point i in column c is 100 i + c.
void Compute(const Block& block, int64_t count, SweepBuffer& buffer) {
  SweepSummary tallies;
  const RowSink places = buffer.SinkOf(block, tallies);
  for (int64_t i = 0; i < count; ++i) {
    for (size_t c = 0; c < places.columns.size(); ++c) {
      places.columns[c][i] = static_cast<double>(100 * (block.first + i)) + static_cast<double>(c);
    }
    if (places.regimes.empty()) continue;
    places.regimes[static_cast<size_t>(i)] = static_cast<Regime>((block.first + i) % 3);
    places.statuses[static_cast<size_t>(i)] = static_cast<RowStatus>((block.first + i) % 5);
  }
  buffer.Finish(block, count, {.points = count});
}

TEST(SweepBufferTest, BlocksAreTakenInOrderAndTheLastIsSmaller) {
  SweepBuffer buffer(10, 5, 1, false);
  for (const int64_t first : {10, 12, 14}) {
    ASSERT_TRUE(buffer.has_unclaimed());
    const std::optional<Block> block = buffer.Claim(2);
    ASSERT_TRUE(block.has_value());
    EXPECT_EQ(block->first, first);
    EXPECT_EQ(block->count, first == 14 ? 1 : 2);
  }
  EXPECT_FALSE(buffer.has_unclaimed());
  EXPECT_FALSE(buffer.Claim(2).has_value());
}

TEST(SweepBufferTest, ABlockIsReadyOnceAllBeforeItAre) {
  SweepBuffer buffer(0, 4, 1, false);
  const Block first = *buffer.Claim(2);
  const Block second = *buffer.Claim(2);
  Compute(second, 2, buffer);
  EXPECT_FALSE(buffer.has_ready());
  Compute(first, 2, buffer);
  EXPECT_TRUE(buffer.has_ready());
  EXPECT_TRUE(buffer.is_complete());
  SweepSummary tallies;
  EXPECT_THAT(buffer.Emit(tallies).values, ElementsAre(0.0, 100.0, 200.0, 300.0));
  EXPECT_EQ(tallies.points, 4);
  EXPECT_FALSE(buffer.has_ready());
}

TEST(SweepBufferTest, PointsThatAreReadyLeaveBeforeTheRest) {
  SweepBuffer buffer(0, 4, 2, true);
  Compute(*buffer.Claim(1), 1, buffer);
  const Block second = *buffer.Claim(1);
  Compute(*buffer.Claim(1), 1, buffer);
  SweepSummary tallies;
  SweepChunk chunk = buffer.Emit(tallies);
  EXPECT_EQ(chunk.first_index, 0);
  EXPECT_EQ(chunk.count, 1);
  EXPECT_THAT(chunk.values, ElementsAre(0.0, 1.0));
  EXPECT_EQ(tallies.points, 1);
  Compute(second, 1, buffer);
  Compute(*buffer.Claim(1), 1, buffer);
  chunk = buffer.Emit(tallies);
  EXPECT_EQ(chunk.first_index, 1);
  EXPECT_THAT(chunk.values, ElementsAre(100.0, 200.0, 300.0, 101.0, 201.0, 301.0));
  EXPECT_THAT(chunk.regimes, ElementsAre(static_cast<Regime>(1), static_cast<Regime>(2), static_cast<Regime>(0)));
  EXPECT_THAT(chunk.statuses,
              ElementsAre(static_cast<RowStatus>(1), static_cast<RowStatus>(2), static_cast<RowStatus>(3)));
  EXPECT_EQ(tallies.points, 4);
}

TEST(SweepBufferTest, TheRestOfABlockIsTakenAgainBeforeLaterPoints) {
  SweepBuffer buffer(0, 10, 1, false);
  const Block block = *buffer.Claim(4);
  Compute(block, 1, buffer);
  const Block rest = *buffer.Claim(100);
  EXPECT_EQ(rest.first, 1);
  EXPECT_EQ(rest.count, 3);
  EXPECT_EQ(buffer.Claim(100)->first, 4);
}

// Blocks of any size, of which any part is computed, in any order, and which leave at any time.
TEST(SweepBufferTest, EveryPointLeavesOnceWhateverTheOrder) {
  std::mt19937_64 random(1);
  for (int round = 0; round < 200; ++round) {
    constexpr int64_t kRoom = 50;
    SweepBuffer buffer(7, kRoom, 1, false);
    std::vector<Block> taken;
    std::vector<double> values;
    SweepSummary tallies;
    while (tallies.points < kRoom) {
      if (const auto block = buffer.Claim(1 + static_cast<int64_t>(random() % 9))) taken.push_back(*block);
      if (random() % 3 > 0 && !taken.empty()) {
        std::swap(taken[random() % taken.size()], taken.back());
        const int64_t count = 1 + static_cast<int64_t>(random() % static_cast<uint64_t>(taken.back().count));
        Compute(taken.back(), count, buffer);
        taken.pop_back();
      }
      if (random() % 4 == 0 && buffer.has_ready()) {
        const SweepChunk chunk = buffer.Emit(tallies);
        ASSERT_EQ(chunk.first_index, 7 + static_cast<int64_t>(values.size()));
        values.insert(values.end(), chunk.values.begin(), chunk.values.end());
      }
    }
    ASSERT_TRUE(buffer.is_complete());
    ASSERT_EQ(values.size(), static_cast<size_t>(kRoom));
    for (int64_t i = 0; i < kRoom; ++i) ASSERT_EQ(values[static_cast<size_t>(i)], 100.0 * static_cast<double>(7 + i));
  }
}

}  // namespace
}  // namespace ricochet
