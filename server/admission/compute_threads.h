// ComputeThreads: a fixed number of threads of low priority, for work that must not delay what is short.
//
// The kernel lets a thread of normal priority run in place of these at once, so that expensive calls may use every core
// and cheap ones still find one. A thread without privileges cannot raise its priority again, which is why the work
// goes to threads of its own and not to those of the handlers.

#ifndef RICOCHET_SERVER_ADMISSION_COMPUTE_THREADS_H_
#define RICOCHET_SERVER_ADMISSION_COMPUTE_THREADS_H_

#include <condition_variable>
#include <deque>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

#include "absl/functional/function_ref.h"

namespace ricochet::server {

// Thread safety: Run may be called from several threads at once.
class ComputeThreads {
 public:
  // Starts `threads` >= 1 threads whose nice value is higher than that of the caller by `nicer`, from 0 to 19.
  ComputeThreads(int threads, int nicer);
  ~ComputeThreads();
  ComputeThreads(const ComputeThreads&) = delete;
  ComputeThreads& operator=(const ComputeThreads&) = delete;

  // Does the work on one of the threads, once one is free, and returns when it is done. An exception that `work` throws
  // is thrown here.
  void Run(absl::FunctionRef<void()> work);

  // Has the work done by one of the threads, once one is free, and returns at once. `work` must not throw.
  void Start(std::function<void()> work);

 private:
  void Serve(int nicer);

  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<std::function<void()>> tasks_;
  bool stopping_ = false;
  std::vector<std::thread> threads_;
};

}  // namespace ricochet::server

#endif  // RICOCHET_SERVER_ADMISSION_COMPUTE_THREADS_H_
