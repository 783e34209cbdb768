#include "core/engine/sweep_run.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <exception>
#include <list>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

#include "core/engine/sweep_buffer.h"
#include "core/numerics/invariant.h"
#include "core/sweep/checked_sweep.h"

namespace ricochet {
namespace {

using Clock = std::chrono::steady_clock;
using Block = SweepBuffer::Block;

constexpr int64_t kFirstChunkPoints = 1024;

// Waking a thread costs some 50 us, so that a sweep that ends sooner than this is computed by its caller alone.
constexpr std::chrono::milliseconds kAloneTime(1);

// Blocks grow until they take this long, in which a lock is nothing, and shrink beyond twice of that, so that no thread
// waits long for the last block of a chunk.
constexpr std::chrono::microseconds kBlockTime(500);

// Threads that share a sweep in SIMD lanes take so many points at once, which is some 10 us, so that they seldom meet at the
// lock.
constexpr int64_t kSharedLanePoints = 2 * SweepPoints::kMostPoints;

// A helper gives back the rest of a block that takes longer than this, because its points have become dear.
constexpr std::chrono::milliseconds kMostBlockTime(10);

// The time between two looks of a caller who waits for helpers.
constexpr std::chrono::milliseconds kBetweenLooks(1);

absl::Status Stopped() { return absl::CancelledError("the sweep was stopped by its caller"); }

}  // namespace

class SweepRun::Impl {
 public:
  Impl(CheckedSweep sweep, std::shared_ptr<Helpers> helpers)
      : sweep_(std::move(sweep)),
        helpers_(std::move(helpers)),
        most_helpers_(helpers_ == nullptr ? 0 : helpers_->most()),
        block_(FirstBlock()),
        next_(sweep_.first) {}
  ~Impl();
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;

  int64_t points_total() const { return sweep_.end - sweep_.first; }
  int64_t points_done() const {
    const std::lock_guard lock(mutex_);
    return points_done_;
  }
  bool ended() const { return ended_; }
  absl::StatusOr<SweepChunk> NextChunk(absl::FunctionRef<bool()> stopped, absl::FunctionRef<bool()> is_enough,
                                       int64_t most_bytes);

 private:
  absl::Status ComputeChunk(absl::FunctionRef<bool()> stopped, absl::FunctionRef<bool()> is_enough, SweepChunk& chunk);

  // A block that a thread computes, with the buffer that it is of.
  struct Task {
    SweepBuffer* buffer = nullptr;
    Block block;
  };

  // Computes a block with the mutex unlocked, and makes its points known. Returns how many they are.
  // Errors: CANCELLED if it was stopped.
  absl::StatusOr<int64_t> Compute(const Task& task, SweepPoints& points, std::unique_lock<std::mutex>& lock,
                                  absl::FunctionRef<bool()> stopped, absl::FunctionRef<bool()> is_enough);
  // Computes the points of a block one group of SIMD lanes after the other. Several threads may call it at once.
  absl::StatusOr<int64_t> ComputePoints(const Task& task, SweepPoints& points, SweepSummary& tallies,
                                        absl::FunctionRef<bool()> stopped, absl::FunctionRef<bool()> is_enough) const;
  // Helps until nothing is to be done, or another needs the thread.
  void Help(absl::FunctionRef<bool()> gives_way);
  void HelpInTurn(SweepPoints& points, absl::FunctionRef<bool()> gives_way, std::unique_lock<std::mutex>& lock);

  // Lanes are fast enough for large blocks, and a caller who is alone leaves none for others to wait for.
  bool adapts_blocks() const { return !sweep_.in_lanes && most_helpers_ > 0; }
  int64_t FirstBlock() const {
    if (adapts_blocks()) return 1;
    return most_helpers_ > 0 ? kSharedLanePoints : SweepPoints::kMostPoints;
  }

  // The functions below are called with the mutex locked.
  // Takes a block, in a new buffer if need be. Nothing if all points are taken or the buffers that may be open are.
  std::optional<Task> Take();
  size_t MostBuffers() const { return caller_is_here_ ? 2 + static_cast<size_t>(most_helpers_) / 4 : 1; }
  bool CanTake() const;
  int64_t RoomOfNextBuffer() const;
  // Asks for as many helpers as could find something to do.
  void AskForHelp(std::unique_lock<std::mutex>& lock);
  void LearnBlockTime(int64_t count, Clock::duration time);
  // True if the first buffer can leave, or has to although it is not full.
  bool CanLeave(bool is_cut) const {
    return !buffers_.empty() && (buffers_.front().is_complete() || (is_cut && buffers_.front().has_ready()));
  }
  SweepChunk Leave();
  std::unique_ptr<SweepPoints> TakeSparePoints();

  const CheckedSweep sweep_;
  const std::shared_ptr<Helpers> helpers_;
  const int most_helpers_;
  std::unique_ptr<SweepPoints> own_points_;  // Of the caller's thread.
  std::optional<Clock::time_point> help_from_;
  bool ended_ = false;

  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::list<SweepBuffer> buffers_;    // In the order of their points.
  int64_t block_;                     // The points that a thread takes at once.
  int64_t next_;                      // The first point that has no buffer yet.
  int64_t most_bytes_ = kChunkBytes;  // The most bytes of values in a buffer that is opened now.
  int64_t points_done_ = 0;
  SweepSummary summary_;  // Of the points that have left.
  bool caller_is_here_ = false;
  std::atomic<bool> stopping_ = false;
  int helping_ = 0;
  std::vector<std::unique_ptr<SweepPoints>> spare_points_;  // Those of helpers that have gone.
  std::exception_ptr failure_;                              // What a helper has met.
};

SweepRun::Impl::~Impl() {
  stopping_ = true;
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [this] { return helping_ == 0; });
}

absl::StatusOr<SweepChunk> SweepRun::Impl::NextChunk(absl::FunctionRef<bool()> stopped,
                                                     absl::FunctionRef<bool()> is_enough, int64_t most_bytes) {
  CheckInvariant(!ended_ && !stopping_, "a sweep has no chunk after its last one or a stop");
  {
    const std::lock_guard lock(mutex_);
    most_bytes_ = most_bytes;
  }
  SweepChunk chunk;
  absl::Status computed;
  try {
    computed = ComputeChunk(stopped, is_enough, chunk);
  } catch (...) {
    stopping_ = true;
    throw;
  }
  if (computed.ok()) return chunk;
  stopping_ = true;
  return computed;
}

absl::Status SweepRun::Impl::ComputeChunk(absl::FunctionRef<bool()> stopped, absl::FunctionRef<bool()> is_enough,
                                          SweepChunk& chunk) {
  if (own_points_ == nullptr) own_points_ = std::make_unique<SweepPoints>(sweep_);
  if (!help_from_.has_value()) help_from_ = Clock::now() + kAloneTime;
  bool has_looked = false;
  bool is_cut = false;
  std::unique_lock lock(mutex_);
  caller_is_here_ = true;
  while (points_total() > 0 && !CanLeave(is_cut)) {
    if (failure_ != nullptr) std::rethrow_exception(failure_);
    const std::optional<Task> task = Take();
    AskForHelp(lock);
    if (task.has_value()) {
      const absl::StatusOr<int64_t> count = Compute(*task, *own_points_, lock, stopped, is_enough);
      if (!count.ok()) return count.status();
      is_cut = *count < task->block.count;
    } else {
      changed_.wait_for(lock, kBetweenLooks);
    }
    lock.unlock();
    if (!task.has_value() && stopped()) return Stopped();
    has_looked = true;
    is_cut = is_cut || is_enough();
    lock.lock();
  }
  chunk = Leave();
  caller_is_here_ = false;
  AskForHelp(lock);
  lock.unlock();
  return !has_looked && stopped() ? Stopped() : absl::OkStatus();
}

absl::StatusOr<int64_t> SweepRun::Impl::Compute(const Task& task, SweepPoints& points,
                                                std::unique_lock<std::mutex>& lock, absl::FunctionRef<bool()> stopped,
                                                absl::FunctionRef<bool()> is_enough) {
  lock.unlock();
  SweepSummary tallies;
  const Clock::time_point start = Clock::now();
  const absl::StatusOr<int64_t> count = ComputePoints(task, points, tallies, stopped, is_enough);
  const Clock::duration time = Clock::now() - start;
  lock.lock();
  if (!count.ok()) return count;
  task.buffer->Finish(task.block, *count, tallies);
  points_done_ += *count;
  if (adapts_blocks()) LearnBlockTime(*count, time);
  return count;
}

absl::StatusOr<int64_t> SweepRun::Impl::ComputePoints(const Task& task, SweepPoints& points, SweepSummary& tallies,
                                                      absl::FunctionRef<bool()> stopped,
                                                      absl::FunctionRef<bool()> is_enough) const {
  int64_t done = 0;
  while (done < task.block.count && (done == 0 || !is_enough())) {
    const Block part = {.first = task.block.first + done,
                        .count = std::min(task.block.count - done, SweepPoints::kMostPoints)};
    const SweepBuffer::Places places = task.buffer->PlacesOf(part);
    const absl::StatusOr<int64_t> count = points.Compute(part.first, part.count, places.columns, places.regimes,
                                                         places.statuses, tallies, stopped, is_enough);
    if (!count.ok()) return count;
    done += *count;
    if (*count < part.count) break;
  }
  return done;
}

void SweepRun::Impl::Help(absl::FunctionRef<bool()> gives_way) {
  std::unique_lock lock(mutex_);
  try {
    std::unique_ptr<SweepPoints> points = TakeSparePoints();
    if (points == nullptr) {
      lock.unlock();
      points = std::make_unique<SweepPoints>(sweep_);
      lock.lock();
    }
    HelpInTurn(*points, gives_way, lock);
    spare_points_.push_back(std::move(points));
  } catch (...) {
    if (!lock.owns_lock()) lock.lock();
    failure_ = std::current_exception();
  }
  --helping_;
  // The run may be gone as soon as the mutex is unlocked.
  changed_.notify_all();
}

void SweepRun::Impl::HelpInTurn(SweepPoints& points, absl::FunctionRef<bool()> gives_way,
                                std::unique_lock<std::mutex>& lock) {
  while (const std::optional<Task> task = Take()) {
    const Clock::time_point end = Clock::now() + kMostBlockTime;
    const absl::StatusOr<int64_t> count = Compute(
        *task, points, lock, [this] { return stopping_.load(); }, [end] { return Clock::now() >= end; });
    if (!count.ok()) return;
    if (task->buffer == &buffers_.front()) changed_.notify_all();
    lock.unlock();
    const bool is_wanted = gives_way();
    lock.lock();
    if (is_wanted) return;
  }
}

std::optional<SweepRun::Impl::Task> SweepRun::Impl::Take() {
  if (!CanTake()) return std::nullopt;
  auto buffer = std::find_if(buffers_.begin(), buffers_.end(), [](const SweepBuffer& b) { return b.has_untaken(); });
  if (buffer == buffers_.end()) {
    const int64_t room = RoomOfNextBuffer();
    buffer = buffers_.emplace(buffers_.end(), next_, room, sweep_.columns.size(), sweep_.with_regime);
    next_ += room;
  }
  return Task{.buffer = &*buffer, .block = *buffer->Take(block_)};
}

bool SweepRun::Impl::CanTake() const {
  if (stopping_) return false;
  if (next_ < sweep_.end && buffers_.size() < MostBuffers()) return true;
  return std::any_of(buffers_.begin(), buffers_.end(), [](const SweepBuffer& b) { return b.has_untaken(); });
}

// The first chunk is small, so that a caller soon sees something.
int64_t SweepRun::Impl::RoomOfNextBuffer() const {
  const auto bytes_a_point = static_cast<int64_t>(sweep_.columns.size() * sizeof(double));
  const int64_t fitting = std::max(most_bytes_ / bytes_a_point, int64_t{1});
  return std::min({next_ == sweep_.first ? kFirstChunkPoints : fitting, fitting, sweep_.end - next_});
}

void SweepRun::Impl::AskForHelp(std::unique_lock<std::mutex>& lock) {
  if (most_helpers_ == 0 || Clock::now() < *help_from_) return;
  while (helping_ < most_helpers_ && CanTake()) {
    ++helping_;
    lock.unlock();
    const bool has_started = helpers_->Start([this](absl::FunctionRef<bool()> gives_way) { Help(gives_way); });
    lock.lock();
    if (has_started) continue;
    --helping_;
    return;
  }
}

void SweepRun::Impl::LearnBlockTime(int64_t count, Clock::duration time) {
  if (count == block_ && time < kBlockTime) block_ = std::min(2 * block_, SweepPoints::kMostPoints);
  if (time > 2 * kBlockTime) block_ = std::max(block_ / 2, int64_t{1});
}

SweepChunk SweepRun::Impl::Leave() {
  SweepChunk chunk = {.first_index = next_};
  if (points_total() > 0) {
    chunk = buffers_.front().Leave(summary_);
    if (buffers_.front().is_complete()) buffers_.pop_front();
  }
  chunk.points_done = summary_.points;
  chunk.points_total = points_total();
  chunk.tallies = summary_;
  ended_ = summary_.points == points_total();
  if (ended_) chunk.summary = summary_;
  return chunk;
}

std::unique_ptr<SweepPoints> SweepRun::Impl::TakeSparePoints() {
  if (spare_points_.empty()) return nullptr;
  std::unique_ptr<SweepPoints> points = std::move(spare_points_.back());
  spare_points_.pop_back();
  return points;
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
