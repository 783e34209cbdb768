#include "core/engine/helper_threads.h"

#include <sched.h>
#include <unistd.h>

#include <algorithm>
#include <cstddef>
#include <system_error>
#include <utility>

namespace ricochet {

int AvailableCores() {
  cpu_set_t cores;
  // It fails on a machine with more than 1024.
  if (sched_getaffinity(0, sizeof(cores), &cores) == 0) return CPU_COUNT(&cores);
  return std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

HelperThreads::HelperThreads(int most) : most_(most), process_(getpid()), pool_(std::make_unique<Pool>()) {}

HelperThreads::~HelperThreads() {
  if (IsForked()) {
    static_cast<void>(pool_.release());  // Its threads are those of the parent.
    return;
  }
  {
    const std::lock_guard lock(pool_->mutex);
    pool_->stopping = true;
  }
  pool_->changed.notify_all();
  for (std::thread& thread : pool_->threads) thread.join();
}

bool HelperThreads::IsForked() const { return getpid() != process_; }

bool HelperThreads::Start(Help help) {
  if (IsForked()) return false;
  {
    const std::lock_guard lock(pool_->mutex);
    if (pool_->helping == most_) return false;
    if (static_cast<size_t>(pool_->helping) == pool_->threads.size() && !pool_->StartThread()) return false;
    ++pool_->helping;
    pool_->waiting.push_back(std::move(help));
  }
  pool_->changed.notify_one();
  return true;
}

bool HelperThreads::Pool::StartThread() {
  try {
    threads.emplace_back([this] { Serve(); });
    return true;
  } catch (const std::system_error&) {
    return false;
  }
}

void HelperThreads::Pool::Serve() {
  std::unique_lock lock(mutex);
  for (;;) {
    changed.wait(lock, [this] { return stopping || !waiting.empty(); });
    if (waiting.empty()) return;
    Help help = std::move(waiting.front());
    waiting.pop_front();
    lock.unlock();
    help([] { return false; });
    help = nullptr;
    lock.lock();
    --helping;
  }
}

}  // namespace ricochet
