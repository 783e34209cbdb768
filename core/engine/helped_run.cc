#include "core/engine/helped_run.h"

#include <utility>

#include "core/base/floating_point_mode.h"

namespace ricochet {
namespace {

// Waking a thread costs some 50 us, so that a run that ends sooner than this is computed by its caller alone.
constexpr std::chrono::milliseconds kAloneTime(1);

// The time between two looks of a caller who waits for helpers.
constexpr std::chrono::milliseconds kBetweenLooks(1);

}  // namespace

HelpedRun::HelpedRun(std::shared_ptr<Helpers> helpers, HasWork has_work, Help help)
    : helpers_(std::move(helpers)),
      most_(helpers_ == nullptr ? 0 : helpers_->most()),
      has_work_(std::move(has_work)),
      help_(std::move(help)) {}

HelpedRun::~HelpedRun() {
  stopping_ = true;
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [this] { return helping_ == 0; });
}

void HelpedRun::Begin() {
  if (!help_from_.has_value()) help_from_ = Clock::now() + kAloneTime;
}

void HelpedRun::AskForHelp(std::unique_lock<std::mutex>& lock) {
  if (most_ == 0 || Clock::now() < *help_from_) return;
  while (helping_ < most_ && has_work_()) {
    ++helping_;
    lock.unlock();
    bool has_started = false;
    std::exception_ptr failure;
    try {
      has_started = helpers_->Start([this](absl::FunctionRef<bool()> gives_way) { RunHelper(gives_way); });
    } catch (...) {
      failure = std::current_exception();
    }
    lock.lock();
    if (has_started) continue;
    --helping_;
    if (failure != nullptr) std::rethrow_exception(failure);
    return;
  }
}

void HelpedRun::RunHelper(absl::FunctionRef<bool()> gives_way) {
  const DefaultFloatingPoint mode;
  std::exception_ptr failure;
  try {
    help_(gives_way);
  } catch (...) {
    failure = std::current_exception();
  }
  const std::lock_guard lock(mutex_);
  if (failure != nullptr) failure_ = failure;
  --helping_;
  // The run may be gone as soon as the mutex is unlocked.
  changed_.notify_all();
}

void HelpedRun::Wait(std::unique_lock<std::mutex>& lock) { changed_.wait_for(lock, kBetweenLooks); }

void HelpedRun::ThrowWhatAHelperMet() const {
  if (failure_ != nullptr) std::rethrow_exception(failure_);
}

}  // namespace ricochet
