#include "server/compute_threads.h"

#include <pthread.h>
#include <sys/resource.h>
#include <unistd.h>

#include <exception>
#include <future>

namespace ricochet::server {

struct ComputeThreads::Task {
  absl::FunctionRef<void()> work;
  std::promise<void> done;
};

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
  Task task{.work = work, .done = {}};
  std::future<void> done = task.done.get_future();
  {
    const std::lock_guard lock(mutex_);
    tasks_.push_back(&task);
  }
  changed_.notify_one();
  done.get();
}

void ComputeThreads::Serve(int nicer) {
  pthread_setname_np(pthread_self(), "compute");
  // On Linux the nice value belongs to the thread. It can always be raised.
  setpriority(PRIO_PROCESS, static_cast<id_t>(gettid()), getpriority(PRIO_PROCESS, 0) + nicer);
  std::unique_lock lock(mutex_);
  for (;;) {
    changed_.wait(lock, [this] { return stopping_ || !tasks_.empty(); });
    if (tasks_.empty()) return;
    Task& task = *tasks_.front();
    tasks_.pop_front();
    lock.unlock();
    // The promise is moved here because its task is gone as soon as the result is set.
    std::promise<void> done = std::move(task.done);
    try {
      task.work();
      done.set_value();
    } catch (...) {
      done.set_exception(std::current_exception());
    }
    lock.lock();
  }
}

}  // namespace ricochet::server
