#include "core/engine/parallel_batch.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <utility>

#include "absl/status/status.h"
#include "core/batch/check_rows.h"

namespace ricochet {
namespace {

using Clock = std::chrono::steady_clock;

// Waking a thread costs some 50 us, so that a batch that ends sooner than this is computed by its caller alone.
constexpr std::chrono::milliseconds kAloneTime(1);

// The time between two looks of a caller who waits for helpers.
constexpr std::chrono::milliseconds kBetweenLooks(1);

absl::Status Stopped() { return absl::CancelledError("the batch was stopped by its caller"); }

BatchRows PartOf(const BatchRows& rows, size_t first, size_t count) {
  BatchRows part;
  for (const absl::Span<const double> column : rows.inputs) part.inputs.push_back(column.subspan(first, count));
  for (const absl::Span<double> column : rows.outputs) part.outputs.push_back(column.subspan(first, count));
  if (!rows.regimes.empty()) part.regimes = rows.regimes.subspan(first, count);
  if (!rows.statuses.empty()) part.statuses = rows.statuses.subspan(first, count);
  return part;
}

}  // namespace

// Job: one batch, while threads take pieces of it.
class ParallelBatch::Job {
 public:
  Job(ParallelBatch& batch, const BatchRows& rows)
      : batch_(batch), rows_(rows), all_(RowCount(rows)), summaries_((all_ + kPiece - 1) / kPiece) {}
  // Waits until nobody helps any more.
  ~Job() {
    stopping_ = true;
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return helping_ == 0; });
  }
  Job(const Job&) = delete;
  Job& operator=(const Job&) = delete;

  absl::StatusOr<BatchSummary> Solve(absl::FunctionRef<bool()> stopped);

 private:
  // Solves the next piece; returns false if there is none or it was stopped.
  bool SolvePiece(BatchRun& run, absl::FunctionRef<bool()> stopped);
  void AskForHelp();
  void Help(absl::FunctionRef<bool()> gives_way);
  // Returns false if it was stopped.
  bool WaitForHelpers(absl::FunctionRef<bool()> stopped);

  ParallelBatch& batch_;
  const BatchRows& rows_;
  const size_t all_;
  std::vector<BatchSummary> summaries_;  // One a piece.
  std::atomic<size_t> next_ = 0;
  std::atomic<bool> stopping_ = false;
  std::mutex mutex_;
  std::condition_variable changed_;
  int helping_ = 0;
  std::exception_ptr failure_;  // What a helper has met.
};

absl::StatusOr<BatchSummary> ParallelBatch::Job::Solve(absl::FunctionRef<bool()> stopped) {
  const Clock::time_point help_from = Clock::now() + kAloneTime;
  while (SolvePiece(*batch_.own_, stopped)) {
    if (Clock::now() >= help_from) AskForHelp();
  }
  if (stopping_ || !WaitForHelpers(stopped)) return Stopped();
  BatchSummary whole;
  for (size_t piece = 0; piece < summaries_.size(); ++piece) {
    whole = Joined(std::move(whole), std::move(summaries_[piece]), static_cast<int64_t>(piece * kPiece));
  }
  return whole;
}

bool ParallelBatch::Job::SolvePiece(BatchRun& run, absl::FunctionRef<bool()> stopped) {
  const size_t piece = next_++;
  if (piece >= summaries_.size()) return false;
  const size_t first = piece * kPiece;
  absl::StatusOr<BatchSummary> summary = run.Solve(PartOf(rows_, first, std::min(kPiece, all_ - first)), stopped);
  if (!summary.ok()) {
    stopping_ = true;
    return false;
  }
  summaries_[piece] = *std::move(summary);
  return true;
}

void ParallelBatch::Job::AskForHelp() {
  if (batch_.helpers_ == nullptr) return;
  std::unique_lock lock(mutex_);
  while (helping_ < batch_.helpers_->most() && next_ < summaries_.size()) {
    ++helping_;
    lock.unlock();
    const bool has_started = batch_.helpers_->Start([this](absl::FunctionRef<bool()> gives_way) { Help(gives_way); });
    lock.lock();
    if (has_started) continue;
    --helping_;
    return;
  }
}

void ParallelBatch::Job::Help(absl::FunctionRef<bool()> gives_way) {
  std::exception_ptr failure;
  try {
    std::unique_ptr<BatchRun> run = batch_.TakeRun();
    while (SolvePiece(*run, [this] { return stopping_.load(); }) && !gives_way()) continue;
    batch_.GiveBack(std::move(run));
  } catch (...) {
    failure = std::current_exception();
  }
  const std::lock_guard lock(mutex_);
  if (failure != nullptr) failure_ = failure;
  --helping_;
  // The job may be gone as soon as the mutex is unlocked.
  changed_.notify_all();
}

bool ParallelBatch::Job::WaitForHelpers(absl::FunctionRef<bool()> stopped) {
  std::unique_lock lock(mutex_);
  while (helping_ > 0) {
    changed_.wait_for(lock, kBetweenLooks);
    lock.unlock();
    if (stopped()) return false;
    lock.lock();
  }
  if (failure_ != nullptr) std::rethrow_exception(failure_);
  return true;
}

ParallelBatch::ParallelBatch(const BatchSetup& setup, std::unique_ptr<BatchRun> own, std::shared_ptr<Helpers> helpers)
    : setup_(setup), own_(std::move(own)), helpers_(std::move(helpers)) {}

absl::StatusOr<std::unique_ptr<ParallelBatch>> ParallelBatch::Make(const BatchSetup& setup,
                                                                   std::shared_ptr<Helpers> helpers) {
  absl::StatusOr<std::unique_ptr<BatchRun>> own = BatchRun::Make(setup);
  if (!own.ok()) return own.status();
  return std::unique_ptr<ParallelBatch>(new ParallelBatch(setup, *std::move(own), std::move(helpers)));
}

std::unique_ptr<BatchRun> ParallelBatch::TakeRun() {
  {
    const std::lock_guard lock(mutex_);
    if (!spare_.empty()) {
      std::unique_ptr<BatchRun> run = std::move(spare_.back());
      spare_.pop_back();
      return run;
    }
  }
  return *BatchRun::Make(setup_);
}

void ParallelBatch::GiveBack(std::unique_ptr<BatchRun> run) {
  const std::lock_guard lock(mutex_);
  spare_.push_back(std::move(run));
}

absl::StatusOr<BatchSummary> ParallelBatch::Solve(const BatchRows& rows, absl::FunctionRef<bool()> stopped) {
  if (RowCount(rows) <= kPiece) return own_->Solve(rows, stopped);
  const absl::Status misfit = CheckRows(rows, setup_.fields.size(), setup_.columns.size());
  if (!misfit.ok()) return misfit;
  return Job(*this, rows).Solve(stopped);
}

}  // namespace ricochet
