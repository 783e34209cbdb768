#include "server/admission/watchdog.h"

#include <condition_variable>
#include <mutex>
#include <utility>

namespace ricochet::server {

std::jthread StartWatchdog(std::chrono::milliseconds pause, std::function<absl::Status(const std::stop_token&)> check,
                           std::function<void(const absl::Status&)> report) {
  return std::jthread([pause, check = std::move(check), report = std::move(report)](const std::stop_token& stop) {
    std::mutex mutex;
    std::condition_variable_any stopped;
    bool was_good = true;
    for (;;) {
      std::unique_lock lock(mutex);
      stopped.wait_for(lock, stop, pause, [] { return false; });
      if (stop.stop_requested()) return;
      const absl::Status status = check(stop);
      if (stop.stop_requested()) return;
      if (status.ok() != was_good) report(status);
      was_good = status.ok();
    }
  });
}

}  // namespace ricochet::server
