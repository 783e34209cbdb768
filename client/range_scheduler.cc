#include "client/range_scheduler.h"

#include <algorithm>
#include <utility>

namespace ricochet {

RangeScheduler::RangeScheduler(int64_t first_index, int64_t end_index, int64_t point_bytes, int64_t buffer_bytes,
                               int64_t servers)
    : end_(end_index),
      point_bytes_(point_bytes),
      room_(std::max<int64_t>(1, buffer_bytes / point_bytes)),
      // While each server computes one range, another one of each may wait.
      longest_range_(std::max<int64_t>(1, room_ / (2 * servers))),
      emitted_(first_index),
      unclaimed_(first_index) {}

std::optional<RangeScheduler::Task> RangeScheduler::Claim(int64_t points) {
  for (Range& range : ranges_) {
    if (range.next < range.end && range.tasks.empty()) return Give(range);
  }
  if (!ranges_.empty() && ranges_.front().wants_another) return Give(ranges_.front());
  const int64_t count = std::min({points, longest_range_, unclaimed()});
  if (count <= 0 || unclaimed_ + count - emitted_ > room_) return std::nullopt;
  ranges_.push_back({.next = unclaimed_, .end = unclaimed_ + count, .tasks = {}, .pieces = {}});
  unclaimed_ += count;
  return Give(ranges_.back());
}

RangeScheduler::Task RangeScheduler::Give(Range& range) {
  range.wants_another = false;
  range.tasks.push_back({.number = ++tasks_,
                         .first_index = range.next,
                         .end_index = range.end,
                         .is_second = !range.tasks.empty(),
                         .stop = {}});
  return range.tasks.back();
}

RangeScheduler::Range* RangeScheduler::Find(const Task& task) {
  for (Range& range : ranges_) {
    for (const Task& one : range.tasks) {
      if (one.number == task.number) return &range;
    }
  }
  return nullptr;
}

bool RangeScheduler::Put(const Task& task, SweepChunk chunk) {
  Range* const range = Find(task);
  if (range == nullptr) return false;
  if (chunk.count == 0) return true;
  for (Task& one : range->tasks) {
    if (one.number != task.number) one.stop.request_stop();
  }
  range->tasks = {task};
  range->wants_another = false;
  range->next += chunk.count;
  waiting_ += chunk.count * point_bytes_;
  most_waiting_ = std::max(most_waiting_, waiting_);
  range->pieces.push_back({task.number, std::move(chunk)});
  return true;
}

void RangeScheduler::End(const Task& task) {
  if (Range* const range = Find(task); range != nullptr) {
    std::erase_if(range->tasks, [&task](const Task& one) { return one.number == task.number; });
  }
}

void RangeScheduler::AskAnother() {
  if (ranges_.empty()) return;
  Range& range = ranges_.front();
  range.wants_another = range.next < range.end && !range.tasks.empty();
}

void RangeScheduler::StopAll() {
  for (Range& range : ranges_) {
    for (Task& task : range.tasks) task.stop.request_stop();
  }
}

std::optional<RangeScheduler::Piece> RangeScheduler::Emit() {
  while (!ranges_.empty() && ranges_.front().pieces.empty()) {
    if (ranges_.front().next < ranges_.front().end) return std::nullopt;
    ranges_.pop_front();
  }
  if (ranges_.empty()) return std::nullopt;
  Piece piece = std::move(ranges_.front().pieces.front());
  ranges_.front().pieces.pop_front();
  emitted_ += piece.chunk.count;
  waiting_ -= piece.chunk.count * point_bytes_;
  return piece;
}

}  // namespace ricochet
