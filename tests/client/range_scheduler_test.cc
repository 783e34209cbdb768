// Tests which server gets which points of a shared sweep, in which order chunks leave, and how much waits meanwhile.

#include "client/range_scheduler.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <optional>

namespace ricochet {
namespace {

using Task = RangeScheduler::Task;

constexpr int64_t kPointBytes = 8;

// 1000 points, room for 400 of them, and two servers, so that a range has at most 100 points.
RangeScheduler Board() { return {0, 1000, kPointBytes, 400 * kPointBytes, 2}; }

// The next `count` points of a task of which `arrived` points were put before.
SweepChunk Chunk(const Task& task, int64_t arrived, int64_t count) {
  return {.first_index = task.first_index + arrived, .count = count};
}

// The index of the first point of the next chunk that leaves, or -1.
int64_t Left(RangeScheduler& scheduler) {
  const std::optional<RangeScheduler::Piece> piece = scheduler.Emit();
  return piece.has_value() ? piece->chunk.first_index : -1;
}

TEST(RangeScheduler, GivesOutDisjointRangesThatCoverAllPoints) {
  RangeScheduler scheduler = Board();
  int64_t next = 0;
  for (const int64_t points : {1, 8, 64, 100, 1000, 1000, 1000, 1000, 1000, 1000, 1000, 1000, 1000}) {
    const std::optional<Task> task = scheduler.Claim(points);
    if (!task.has_value()) break;
    EXPECT_EQ(task->first_index, next);
    EXPECT_LE(task->end_index - next, std::min<int64_t>(points, 100));
    next = task->end_index;
    EXPECT_TRUE(scheduler.Put(*task, Chunk(*task, 0, task->end_index - task->first_index)));
    EXPECT_EQ(Left(scheduler), task->first_index);
  }
  EXPECT_EQ(next, 1000);
  EXPECT_EQ(scheduler.next_index(), 1000);
  EXPECT_EQ(scheduler.unclaimed(), 0);
}

TEST(RangeScheduler, ChunksLeaveInTheOrderOfThePoints) {
  RangeScheduler scheduler = Board();
  const Task first = scheduler.Claim(10).value();
  const Task second = scheduler.Claim(10).value();
  EXPECT_TRUE(scheduler.Put(second, Chunk(second, 0, 4)));
  EXPECT_TRUE(scheduler.Put(second, Chunk(second, 4, 6)));
  EXPECT_EQ(Left(scheduler), -1);
  EXPECT_TRUE(scheduler.Put(first, Chunk(first, 0, 7)));
  EXPECT_EQ(Left(scheduler), 0);
  EXPECT_EQ(Left(scheduler), -1);
  EXPECT_TRUE(scheduler.Put(first, Chunk(first, 7, 3)));
  EXPECT_EQ(Left(scheduler), 7);
  EXPECT_EQ(Left(scheduler), 10);
  EXPECT_EQ(Left(scheduler), 14);
}

TEST(RangeScheduler, PointsAreGivenOutOnlyIfThereIsRoomForThem) {
  RangeScheduler scheduler = Board();
  const Task first = scheduler.Claim(100).value();
  for (int i = 0; i < 3; ++i) {
    const Task other = scheduler.Claim(100).value();
    EXPECT_TRUE(scheduler.Put(other, Chunk(other, 0, 100)));
  }
  EXPECT_FALSE(scheduler.Claim(1).has_value());
  EXPECT_EQ(scheduler.most_waiting_bytes(), 300 * kPointBytes);
  EXPECT_TRUE(scheduler.Put(first, Chunk(first, 0, 60)));
  EXPECT_FALSE(scheduler.Claim(1).has_value());
  EXPECT_EQ(Left(scheduler), 0);
  EXPECT_FALSE(scheduler.Claim(61).has_value());
  EXPECT_TRUE(scheduler.Claim(60).has_value());
  EXPECT_EQ(scheduler.most_waiting_bytes(), 360 * kPointBytes);
}

TEST(RangeScheduler, OnePointFitsIntoAnyBuffer) {
  RangeScheduler scheduler(0, 2, kPointBytes, 1, 3);
  const Task task = scheduler.Claim(1000).value();
  EXPECT_EQ(task.end_index, 1);
  EXPECT_FALSE(scheduler.Claim(1).has_value());
}

TEST(RangeScheduler, TheRestOfARangeWhoseServerFailedIsGivenOutFirst) {
  RangeScheduler scheduler = Board();
  const Task failing = scheduler.Claim(50).value();
  const Task other = scheduler.Claim(50).value();
  EXPECT_TRUE(scheduler.Put(failing, Chunk(failing, 0, 20)));
  scheduler.End(failing);
  const Task rest = scheduler.Claim(1).value();
  EXPECT_EQ(rest.first_index, 20);
  EXPECT_EQ(rest.end_index, 50);
  EXPECT_EQ(scheduler.Claim(1)->first_index, other.end_index);
  EXPECT_FALSE(scheduler.Put(failing, Chunk(failing, 20, 5)));
}

TEST(RangeScheduler, OfTwoServersForOneRangeTheFirstToAnswerGoesOn) {
  for (const bool second_wins : {false, true}) {
    RangeScheduler scheduler = Board();
    const Task first = scheduler.Claim(50).value();
    EXPECT_TRUE(scheduler.Put(first, Chunk(first, 0, 20)));
    scheduler.AskAnother();
    const Task second = scheduler.Claim(100).value();
    EXPECT_EQ(second.first_index, 20);
    EXPECT_EQ(second.end_index, 50);
    EXPECT_EQ(second.is_second, true);
    EXPECT_EQ(scheduler.Claim(100)->first_index, 50) << "a third server was asked, too";
    EXPECT_TRUE(scheduler.Put(second_wins ? second : first, Chunk(first, 20, 5)));
    EXPECT_EQ(first.stop.stop_requested(), second_wins);
    EXPECT_EQ(second.stop.stop_requested(), !second_wins);
    EXPECT_FALSE(scheduler.Put(second_wins ? first : second, Chunk(first, 20, 30)));
    EXPECT_TRUE(scheduler.Put(second_wins ? second : first, Chunk(first, 25, 25)));
  }
}

TEST(RangeScheduler, AnEmptyChunkIsNoAnswer) {
  RangeScheduler scheduler = Board();
  const Task first = scheduler.Claim(50).value();
  scheduler.AskAnother();
  const Task second = scheduler.Claim(50).value();
  EXPECT_TRUE(scheduler.Put(second, Chunk(second, 0, 0)));
  EXPECT_FALSE(first.stop.stop_requested());
}

}  // namespace
}  // namespace ricochet
