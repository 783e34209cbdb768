// Which server gets which points of a shared sweep, in which order their chunks leave, and how much waits meanwhile.

#include "client/range_board.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <optional>

namespace ricochet {
namespace {

using Task = RangeBoard::Task;

constexpr int64_t kPointBytes = 8;

// 1000 points, room for 400 of them, and two servers, so that a range has at most 100 points.
RangeBoard Board() { return {0, 1000, kPointBytes, 400 * kPointBytes, 2}; }

// The next `count` points of a task of which `arrived` points were put before.
SweepChunk Chunk(const Task& task, int64_t arrived, int64_t count) {
  return {.first_index = task.first_index + arrived, .count = count};
}

// The index of the first point of the next chunk that leaves, or -1.
int64_t Left(RangeBoard& board) {
  const std::optional<RangeBoard::Piece> piece = board.Leave();
  return piece.has_value() ? piece->chunk.first_index : -1;
}

TEST(RangeBoard, GivesOutDisjointRangesThatCoverAllPoints) {
  RangeBoard board = Board();
  int64_t next = 0;
  for (const int64_t points : {1, 8, 64, 100, 1000, 1000, 1000, 1000, 1000, 1000, 1000, 1000, 1000}) {
    const std::optional<Task> task = board.Take(points);
    if (!task.has_value()) break;
    EXPECT_EQ(task->first_index, next);
    EXPECT_LE(task->end_index - next, std::min<int64_t>(points, 100));
    next = task->end_index;
    EXPECT_TRUE(board.Put(*task, Chunk(*task, 0, task->end_index - task->first_index)));
    EXPECT_EQ(Left(board), task->first_index);
  }
  EXPECT_EQ(next, 1000);
  EXPECT_EQ(board.next_index(), 1000);
  EXPECT_EQ(board.untaken(), 0);
}

TEST(RangeBoard, ChunksLeaveInTheOrderOfThePoints) {
  RangeBoard board = Board();
  const Task first = board.Take(10).value();
  const Task second = board.Take(10).value();
  EXPECT_TRUE(board.Put(second, Chunk(second, 0, 4)));
  EXPECT_TRUE(board.Put(second, Chunk(second, 4, 6)));
  EXPECT_EQ(Left(board), -1);
  EXPECT_TRUE(board.Put(first, Chunk(first, 0, 7)));
  EXPECT_EQ(Left(board), 0);
  EXPECT_EQ(Left(board), -1);
  EXPECT_TRUE(board.Put(first, Chunk(first, 7, 3)));
  EXPECT_EQ(Left(board), 7);
  EXPECT_EQ(Left(board), 10);
  EXPECT_EQ(Left(board), 14);
}

TEST(RangeBoard, PointsAreGivenOutOnlyIfThereIsRoomForThem) {
  RangeBoard board = Board();
  const Task first = board.Take(100).value();
  for (int i = 0; i < 3; ++i) {
    const Task other = board.Take(100).value();
    EXPECT_TRUE(board.Put(other, Chunk(other, 0, 100)));
  }
  EXPECT_FALSE(board.Take(1).has_value());
  EXPECT_EQ(board.most_waiting_bytes(), 300 * kPointBytes);
  EXPECT_TRUE(board.Put(first, Chunk(first, 0, 60)));
  EXPECT_FALSE(board.Take(1).has_value());
  EXPECT_EQ(Left(board), 0);
  EXPECT_FALSE(board.Take(61).has_value());
  EXPECT_TRUE(board.Take(60).has_value());
  EXPECT_EQ(board.most_waiting_bytes(), 360 * kPointBytes);
}

TEST(RangeBoard, OnePointFitsIntoAnyBuffer) {
  RangeBoard board(0, 2, kPointBytes, 1, 3);
  const Task task = board.Take(1000).value();
  EXPECT_EQ(task.end_index, 1);
  EXPECT_FALSE(board.Take(1).has_value());
}

TEST(RangeBoard, TheRestOfARangeWhoseServerFailedIsGivenOutFirst) {
  RangeBoard board = Board();
  const Task failing = board.Take(50).value();
  const Task other = board.Take(50).value();
  EXPECT_TRUE(board.Put(failing, Chunk(failing, 0, 20)));
  board.End(failing);
  const Task rest = board.Take(1).value();
  EXPECT_EQ(rest.first_index, 20);
  EXPECT_EQ(rest.end_index, 50);
  EXPECT_EQ(board.Take(1)->first_index, other.end_index);
  EXPECT_FALSE(board.Put(failing, Chunk(failing, 20, 5)));
}

TEST(RangeBoard, OfTwoServersForOneRangeTheFirstToAnswerGoesOn) {
  for (const bool second_wins : {false, true}) {
    RangeBoard board = Board();
    const Task first = board.Take(50).value();
    EXPECT_TRUE(board.Put(first, Chunk(first, 0, 20)));
    board.AskAnother();
    const Task second = board.Take(100).value();
    EXPECT_EQ(second.first_index, 20);
    EXPECT_EQ(second.end_index, 50);
    EXPECT_EQ(second.is_second, true);
    EXPECT_EQ(board.Take(100)->first_index, 50) << "a third server was asked, too";
    EXPECT_TRUE(board.Put(second_wins ? second : first, Chunk(first, 20, 5)));
    EXPECT_EQ(first.stop.stop_requested(), second_wins);
    EXPECT_EQ(second.stop.stop_requested(), !second_wins);
    EXPECT_FALSE(board.Put(second_wins ? first : second, Chunk(first, 20, 30)));
    EXPECT_TRUE(board.Put(second_wins ? second : first, Chunk(first, 25, 25)));
  }
}

TEST(RangeBoard, AnEmptyChunkIsNoAnswer) {
  RangeBoard board = Board();
  const Task first = board.Take(50).value();
  board.AskAnother();
  const Task second = board.Take(50).value();
  EXPECT_TRUE(board.Put(second, Chunk(second, 0, 0)));
  EXPECT_FALSE(first.stop.stop_requested());
}

}  // namespace
}  // namespace ricochet
