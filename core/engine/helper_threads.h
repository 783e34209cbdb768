// HelperThreads: the threads of a LocalSolver that help its calls. A thread starts when a call first needs it, and then
// waits for the next call.

#ifndef RICOCHET_CORE_ENGINE_HELPER_THREADS_H_
#define RICOCHET_CORE_ENGINE_HELPER_THREADS_H_

#include <sys/types.h>

#include <condition_variable>
#include <deque>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

#include "ricochet/helpers.h"

namespace ricochet {

class HelperThreads final : public Helpers {
 public:
  // At most `most` >= 0 threads.
  explicit HelperThreads(int most);
  // Waits until no thread helps any more. No thread of this object may destroy it.
  ~HelperThreads() override;

  int most() const override { return most_; }
  // Returns false as well if the system gives no more threads, and in a process that was forked.
  bool Start(Help help) override;

 private:
  struct Pool {
    void Serve();
    // Called with the mutex locked.
    bool StartThread();

    std::mutex mutex;
    std::condition_variable changed;
    std::deque<Help> waiting;
    int helping = 0;  // Helps that were accepted and have not returned.
    bool stopping = false;
    std::vector<std::thread> threads;
  };

  // A fork copies this object without its threads, so that the copy must neither use nor destroy its pool.
  bool IsForked() const;

  const int most_;
  const pid_t process_;
  std::unique_ptr<Pool> pool_;
};

}  // namespace ricochet

#endif  // RICOCHET_CORE_ENGINE_HELPER_THREADS_H_
