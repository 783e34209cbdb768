#include "server/admission/compute_threads.h"

#include <pthread.h>
#include <sys/resource.h>
#include <unistd.h>

#include <future>
#include <memory>
#include <utility>

namespace ricochet::server {

ComputeThreads::ComputeThreads(int threads, int nicer) {
  for (int i = 0; i < threads; ++i) threads_.emplace_back([this, nicer] { Serve(nicer); });
}

ComputeThreads::~ComputeThreads() {
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
  }
  changed_.notify_all();
  for (std::thread& thread : threads_) thread.join();
}

void ComputeThreads::Run(absl::FunctionRef<void()> work) {
  // Shared, because this function may have returned before the other thread has left the task.
  const auto task = std::make_shared<std::packaged_task<void()>>(work);
  std::future<void> ended = task->get_future();
  Start([task] { (*task)(); });
  ended.get();
}

void ComputeThreads::Start(std::function<void()> work) {
  {
    const std::lock_guard lock(mutex_);
    tasks_.push_back(std::move(work));
  }
  changed_.notify_one();
}

void ComputeThreads::Serve(int nicer) {
  pthread_setname_np(pthread_self(), "compute");
  // On Linux the nice value belongs to the thread. It can always be raised.
  setpriority(PRIO_PROCESS, static_cast<id_t>(gettid()), getpriority(PRIO_PROCESS, 0) + nicer);
  std::unique_lock lock(mutex_);
  for (;;) {
    changed_.wait(lock, [this] { return stopping_ || !tasks_.empty(); });
    if (tasks_.empty()) return;
    std::function<void()> task = std::move(tasks_.front());
    tasks_.pop_front();
    lock.unlock();
    task();
    task = nullptr;
    lock.lock();
  }
}

}  // namespace ricochet::server
