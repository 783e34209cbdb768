#include "core/engine/helper_threads.h"

#include <algorithm>
#include <cstddef>
#include <system_error>
#include <utility>

namespace ricochet {

int AvailableCores() {
  static const int cores = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  return cores;
}

HelperThreads::~HelperThreads() {
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
  }
  changed_.notify_all();
  for (std::thread& thread : threads_) thread.join();
}

bool HelperThreads::Start(Help help) {
  {
    const std::lock_guard lock(mutex_);
    if (helping_ == most_) return false;
    if (static_cast<size_t>(helping_) == threads_.size() && !StartThread()) return false;
    ++helping_;
    waiting_.push_back(std::move(help));
  }
  changed_.notify_one();
  return true;
}

bool HelperThreads::StartThread() {
  try {
    threads_.emplace_back([this] { Serve(); });
    return true;
  } catch (const std::system_error&) {
    return false;
  }
}

void HelperThreads::Serve() {
  std::unique_lock lock(mutex_);
  for (;;) {
    changed_.wait(lock, [this] { return stopping_ || !waiting_.empty(); });
    if (waiting_.empty()) return;
    Help help = std::move(waiting_.front());
    waiting_.pop_front();
    lock.unlock();
    help([] { return false; });
    help = nullptr;
    lock.lock();
    --helping_;
  }
}

}  // namespace ricochet
