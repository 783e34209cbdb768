// CountedThreads: threads that help a call, and how often they did.

#ifndef RICOCHET_TESTS_SUPPORT_PROCESSES_COUNTED_THREADS_H_
#define RICOCHET_TESTS_SUPPORT_PROCESSES_COUNTED_THREADS_H_

#include <atomic>
#include <utility>

#include "core/engine/helper_threads.h"

namespace ricochet {

// It can have every help give way at once.
class CountedThreads final : public Helpers {
 public:
  explicit CountedThreads(int most, bool gives_way = false) : threads_(most), gives_way_(gives_way) {}

  int most() const override { return threads_.most(); }
  bool Start(Help help) override {
    return threads_.Start([this, help = std::move(help)](absl::FunctionRef<bool()> /*gives_way*/) mutable {
      ++started_;
      ++running_;
      help([this] { return gives_way_; });
      --running_;
    });
  }
  int started() const { return started_; }
  int running() const { return running_; }

 private:
  std::atomic<int> started_ = 0;
  std::atomic<int> running_ = 0;
  HelperThreads threads_;
  const bool gives_way_;
};

}  // namespace ricochet

#endif  // RICOCHET_TESTS_SUPPORT_PROCESSES_COUNTED_THREADS_H_
