// HelperThreads: the threads of a LocalSolver that help its calls. A thread starts when a call first needs it, and then
// waits for the next call.

#ifndef RICOCHET_CORE_ENGINE_HELPER_THREADS_H_
#define RICOCHET_CORE_ENGINE_HELPER_THREADS_H_

#include <condition_variable>
#include <deque>
#include <mutex>
#include <thread>
#include <vector>

#include "ricochet/helpers.h"

namespace ricochet {

class HelperThreads final : public Helpers {
 public:
  // At most `most` >= 0 threads.
  explicit HelperThreads(int most) : most_(most) {}
  // Waits until no thread helps any more. No thread of this object may destroy it.
  ~HelperThreads() override;

  int most() const override { return most_; }
  // Returns false as well if the system gives no more threads.
  bool Start(Help help) override;

 private:
  void Serve();
  // Called with the mutex locked.
  bool StartThread();

  const int most_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<Help> waiting_;
  int helping_ = 0;  // Helps that were accepted and have not returned.
  bool stopping_ = false;
  std::vector<std::thread> threads_;
};

}  // namespace ricochet

#endif  // RICOCHET_CORE_ENGINE_HELPER_THREADS_H_
