// RangeScheduler: the points of one sweep that several servers compute, range by range: which server has which range,
// and the chunks that wait until the points before them have left.

#ifndef RICOCHET_CLIENT_RANGE_SCHEDULER_H_
#define RICOCHET_CLIENT_RANGE_SCHEDULER_H_

#include <cstdint>
#include <deque>
#include <optional>
#include <stop_token>
#include <vector>

#include "ricochet/sweep.h"

namespace ricochet {

// The buffer is bounded, because a range is given out only if there is room for all of it. So a task that was given out
// never waits for room, and neither does the reader for a task.
//
// Thread safety: one thread at a time.
class RangeScheduler {
 public:
  // One call to one server, for the points of a range that have not arrived.
  struct Task {
    int64_t number = 0;  // Counts the tasks from 1.
    int64_t first_index = 0;
    int64_t end_index = 0;
    bool is_second = false;  // True if another server was asked before and is slow.
    std::stop_source stop;   // Triggered once the answer is not needed any more.
  };
  // A chunk as its call gave it.
  struct Piece {
    int64_t task = 0;
    SweepChunk chunk;
  };

  // The points [first_index, end_index), of `point_bytes` each, which `servers` >= 1 compute. At most `buffer_bytes` of
  // them are out or wait, but at least one point.
  RangeScheduler(int64_t first_index, int64_t end_index, int64_t point_bytes, int64_t buffer_bytes, int64_t servers);

  // Gives out the first range that nobody computes; else the one that the reader waits for, if AskAnother was called;
  // else a new one of at most `points` >= 1 points. Nothing if there is no point left, or no room.
  std::optional<Task> Claim(int64_t points);

  // Takes the next chunk of a task, and triggers the stop of any other task for its range. Returns false if that
  // happened to this task.
  bool Put(const Task& task, SweepChunk chunk);

  // Says that a task has ended. Nobody computes the rest of its range unless there is another task for it.
  void End(const Task& task);

  // Says that the reader has waited for long, so that a second server is asked for the same points.
  void AskAnother();

  // Triggers the stops of all tasks.
  void StopAll();

  // Returns the next chunk in the order of the points, if it is there.
  std::optional<Piece> Emit();

  int64_t next_index() const { return emitted_; }               // The first point that has not left.
  int64_t unclaimed() const { return end_ - unclaimed_; }       // The number of points that were never given out.
  int64_t most_waiting_bytes() const { return most_waiting_; }  // The most bytes of chunks that ever waited.

 private:
  struct Range {
    int64_t next = 0;  // The first point that has not arrived.
    int64_t end = 0;
    std::vector<Task> tasks;
    bool wants_another = false;
    std::deque<Piece> pieces;
  };

  Task Give(Range& range);
  Range* Find(const Task& task);

  const int64_t end_;
  const int64_t point_bytes_;
  const int64_t room_;           // Points.
  const int64_t longest_range_;  // Points.
  std::deque<Range> ranges_;     // Some point of each has not left yet.
  int64_t emitted_;
  int64_t unclaimed_;
  int64_t tasks_ = 0;
  int64_t waiting_ = 0;  // Bytes of all pieces.
  int64_t most_waiting_ = 0;
};

}  // namespace ricochet

#endif  // RICOCHET_CLIENT_RANGE_SCHEDULER_H_
