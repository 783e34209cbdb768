#include "core/engine/sweep_run.h"

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <list>
#include <mutex>
#include <optional>
#include <utility>

#include "core/base/invariant.h"
#include "core/engine/helped_run.h"
#include "core/engine/pool.h"
#include "core/engine/sweep_buffer.h"
#include "core/rows/checked_rows.h"
#include "core/rows/row_source.h"
#include "core/types/grid.h"

namespace ricochet {
namespace {

using Clock = std::chrono::steady_clock;
using Block = SweepBuffer::Block;

constexpr int64_t kFirstChunkPoints = 1024;

// If threads share a sweep, their blocks grow until they take this long, against which a lock costs nothing, and shrink
// beyond twice that, so that no thread waits long for the last block of a chunk.
constexpr std::chrono::microseconds kBlockTime(500);

// Threads that share a sweep in SIMD lanes take this many points at once, at first and at most. The most takes some 20
// us where points are cheapest.
constexpr int64_t kFirstLanePoints = 2 * RowSolver::kRowsBetweenStops;
constexpr int64_t kMostLanePoints = 8 * RowSolver::kRowsBetweenStops;

// The most points that a thread takes at once, where it is alone or points have no lanes.
constexpr int64_t kMostPoints = 1024;

// A helper gives back the rest of a block that takes longer than this, because its points have become expensive.
constexpr std::chrono::milliseconds kMostBlockTime(10);

absl::Status Stopped() { return absl::CancelledError("the sweep was stopped by its caller"); }

}  // namespace

class SweepRun::Impl {
 public:
  Impl(CheckedSweep sweep, std::shared_ptr<Helpers> helpers);
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;

  int64_t points_total() const { return sweep_.end - sweep_.first; }
  int64_t points_done() const {
    const std::lock_guard lock(helped_.mutex());
    return points_done_;
  }
  bool ended() const { return ended_; }
  absl::StatusOr<SweepChunk> NextChunk(absl::FunctionRef<bool()> stopped, absl::FunctionRef<bool()> is_enough,
                                       int64_t most_bytes);

 private:
  // Each thread that computes points uses an object of this type for itself.
  struct Points {
    explicit Points(const CheckedSweep& sweep)
        : source(sweep.grid), solver(sweep.grid.scene, AxisPaths(sweep.grid), sweep.columns, sweep.demand) {}
    GridRows source;
    RowSolver solver;
  };

  // A block that a thread computes, with the buffer that it is of.
  struct Task {
    SweepBuffer* buffer = nullptr;
    Block block;
  };

  absl::Status ComputeChunk(absl::FunctionRef<bool()> stopped, absl::FunctionRef<bool()> is_enough, SweepChunk& chunk);
  // Computes a block with the mutex unlocked, and makes its points known. Returns how many they are, or nothing if it
  // was stopped.
  std::optional<int64_t> Compute(const Task& task, Points& points, std::unique_lock<std::mutex>& lock,
                                 absl::FunctionRef<bool()> stopped, absl::FunctionRef<bool()> is_enough);
  // Helps until nothing is to be done, or another needs the thread.
  void Help(absl::FunctionRef<bool()> gives_way);

  // Without helpers nobody waits for a block, so that blocks need not adapt.
  bool adapts_blocks() const { return helped_.most_helpers() > 0; }
  int64_t FirstBlock() const {
    if (!adapts_blocks()) return kMostPoints;
    return sweep_.in_lanes ? kFirstLanePoints : 1;
  }
  int64_t MostBlock() const { return sweep_.in_lanes ? kMostLanePoints : kMostPoints; }

  // The functions below are called with the mutex locked.
  // Takes a block, in a new buffer if need be. Nothing if all points are taken or the buffers that may be open are.
  std::optional<Task> Claim();
  size_t MostBuffers() const { return caller_is_here_ ? 2 + static_cast<size_t>(helped_.most_helpers()) / 4 : 1; }
  bool CanTake() const;
  int64_t RoomOfNextBuffer() const;
  void LearnBlockTime(int64_t count, Clock::duration time);
  // True if the first buffer can leave, or has to although it is not full.
  bool CanLeave(bool is_cut) const {
    return !buffers_.empty() && (buffers_.front().is_complete() || (is_cut && buffers_.front().has_ready()));
  }
  SweepChunk Emit();

  const CheckedSweep sweep_;
  Pool<Points> points_;
  Pool<Points>::Taken own_points_;  // The caller's thread uses them.
  bool ended_ = false;

  std::list<SweepBuffer> buffers_;    // In the order of their points.
  int64_t block_ = 1;                 // The points that a thread takes at once.
  int64_t next_;                      // The first point that has no buffer yet.
  int64_t most_bytes_ = kChunkBytes;  // The most bytes of values in a buffer that is opened now.
  int64_t points_done_ = 0;
  SweepSummary summary_;  // It counts the points that have left.
  bool caller_is_here_ = false;
  HelpedRun helped_;  // Its mutex guards what is above, but for the points and whether the run has ended.
};

SweepRun::Impl::Impl(CheckedSweep sweep, std::shared_ptr<Helpers> helpers)
    : sweep_(std::move(sweep)),
      points_([this] { return std::make_unique<Points>(sweep_); }),
      next_(sweep_.first),
      helped_(
          std::move(helpers), [this] { return CanTake(); },
          [this](absl::FunctionRef<bool()> gives_way) { Help(gives_way); }) {
  block_ = FirstBlock();
}

absl::StatusOr<SweepChunk> SweepRun::Impl::NextChunk(absl::FunctionRef<bool()> stopped,
                                                     absl::FunctionRef<bool()> is_enough, int64_t most_bytes) {
  CheckInvariant(!ended_ && !helped_.is_stopping(), "a sweep has no chunk after its last one or a stop");
  {
    const std::lock_guard lock(helped_.mutex());
    most_bytes_ = most_bytes;
  }
  SweepChunk chunk;
  absl::Status computed;
  try {
    computed = ComputeChunk(stopped, is_enough, chunk);
  } catch (...) {
    helped_.Stop();
    throw;
  }
  if (computed.ok()) return chunk;
  helped_.Stop();
  return computed;
}

absl::Status SweepRun::Impl::ComputeChunk(absl::FunctionRef<bool()> stopped, absl::FunctionRef<bool()> is_enough,
                                          SweepChunk& chunk) {
  if (own_points_ == nullptr) own_points_ = points_.Take();
  helped_.Begin();
  bool has_looked = false;
  bool is_cut = false;
  std::unique_lock lock(helped_.mutex());
  caller_is_here_ = true;
  while (points_total() > 0 && !CanLeave(is_cut)) {
    helped_.ThrowWhatAHelperMet();
    const std::optional<Task> task = Claim();
    helped_.AskForHelp(lock);
    if (task.has_value()) {
      const std::optional<int64_t> count = Compute(*task, *own_points_, lock, stopped, is_enough);
      if (!count.has_value()) return Stopped();
      is_cut = *count < task->block.count;
    } else {
      helped_.Wait(lock);
    }
    lock.unlock();
    if (!task.has_value() && stopped()) return Stopped();
    has_looked = true;
    is_cut = is_cut || is_enough();
    lock.lock();
  }
  chunk = Emit();
  caller_is_here_ = false;
  helped_.AskForHelp(lock);
  lock.unlock();
  return !has_looked && stopped() ? Stopped() : absl::OkStatus();
}

std::optional<int64_t> SweepRun::Impl::Compute(const Task& task, Points& points, std::unique_lock<std::mutex>& lock,
                                               absl::FunctionRef<bool()> stopped, absl::FunctionRef<bool()> is_enough) {
  lock.unlock();
  SweepSummary tallies;
  const Clock::time_point start = Clock::now();
  const std::optional<int64_t> count = points.solver.Solve(
      points.source, task.block.first, task.block.count, task.buffer->SinkOf(task.block, tallies), stopped, is_enough);
  const Clock::duration time = Clock::now() - start;
  lock.lock();
  if (!count.has_value()) return count;
  task.buffer->Finish(task.block, *count, tallies);
  points_done_ += *count;
  if (adapts_blocks()) LearnBlockTime(*count, time);
  return count;
}

void SweepRun::Impl::Help(absl::FunctionRef<bool()> gives_way) {
  const Pool<Points>::Taken points = points_.Take();
  std::unique_lock lock(helped_.mutex());
  while (const std::optional<Task> task = Claim()) {
    const Clock::time_point end = Clock::now() + kMostBlockTime;
    const auto stopped = [this] { return helped_.is_stopping(); };
    const auto is_enough = [end] { return Clock::now() >= end; };
    if (!Compute(*task, *points, lock, stopped, is_enough).has_value()) return;
    if (task->buffer == &buffers_.front()) helped_.Tell();
    lock.unlock();
    if (gives_way()) return;
    lock.lock();
  }
}

std::optional<SweepRun::Impl::Task> SweepRun::Impl::Claim() {
  if (!CanTake()) return std::nullopt;
  auto buffer = std::find_if(buffers_.begin(), buffers_.end(), [](const SweepBuffer& b) { return b.has_unclaimed(); });
  if (buffer == buffers_.end()) {
    const int64_t room = RoomOfNextBuffer();
    buffer = buffers_.emplace(buffers_.end(), next_, room, sweep_.columns.size(), sweep_.with_regime);
    next_ += room;
  }
  return Task{.buffer = &*buffer, .block = *buffer->Claim(block_)};
}

bool SweepRun::Impl::CanTake() const {
  if (helped_.is_stopping()) return false;
  if (next_ < sweep_.end && buffers_.size() < MostBuffers()) return true;
  return std::any_of(buffers_.begin(), buffers_.end(), [](const SweepBuffer& b) { return b.has_unclaimed(); });
}

// The first chunk is small, so that a caller soon sees something.
int64_t SweepRun::Impl::RoomOfNextBuffer() const {
  const auto bytes_a_point = static_cast<int64_t>(sweep_.columns.size() * sizeof(double));
  const int64_t fitting = std::max(most_bytes_ / bytes_a_point, int64_t{1});
  return std::min({next_ == sweep_.first ? kFirstChunkPoints : fitting, fitting, sweep_.end - next_});
}

void SweepRun::Impl::LearnBlockTime(int64_t count, Clock::duration time) {
  if (count == block_ && time < kBlockTime) block_ = std::min(2 * block_, MostBlock());
  if (time > 2 * kBlockTime) block_ = std::max(block_ / 2, int64_t{1});
}

SweepChunk SweepRun::Impl::Emit() {
  SweepChunk chunk = {.first_index = next_};
  if (points_total() > 0) {
    chunk = buffers_.front().Emit(summary_);
    if (buffers_.front().is_complete()) buffers_.pop_front();
  }
  chunk.points_done = summary_.points;
  chunk.points_total = points_total();
  chunk.tallies = summary_;
  ended_ = summary_.points == points_total();
  if (ended_) chunk.summary = summary_;
  return chunk;
}

absl::StatusOr<SweepRun> SweepRun::Make(const SweepRequest& request, std::shared_ptr<Helpers> helpers) {
  absl::StatusOr<CheckedSweep> sweep = CheckSweep(request);
  if (!sweep.ok()) return sweep.status();
  return SweepRun(std::make_unique<Impl>(*std::move(sweep), std::move(helpers)));
}

SweepRun::SweepRun(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
SweepRun::SweepRun(SweepRun&&) noexcept = default;
SweepRun& SweepRun::operator=(SweepRun&&) noexcept = default;
SweepRun::~SweepRun() = default;

int64_t SweepRun::points_total() const { return impl_->points_total(); }
int64_t SweepRun::points_done() const { return impl_->points_done(); }
bool SweepRun::ended() const { return impl_->ended(); }
absl::StatusOr<SweepChunk> SweepRun::NextChunk(absl::FunctionRef<bool()> stopped, absl::FunctionRef<bool()> is_enough,
                                               int64_t most_bytes) {
  return impl_->NextChunk(stopped, is_enough, most_bytes);
}

}  // namespace ricochet
