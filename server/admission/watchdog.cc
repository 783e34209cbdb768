#include "server/admission/watchdog.h"

#include <condition_variable>
#include <mutex>
#include <utility>

namespace ricochet::server {
namespace {

void Watch(const std::stop_token& stop, std::chrono::milliseconds pause, const Watchdog::Check& check,
           const Watchdog::Report& report) {
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
}

}  // namespace

Watchdog::Watchdog(std::chrono::milliseconds pause, Check check, Report report)
    : thread_([pause, check = std::move(check), report = std::move(report)](const std::stop_token& stop) {
        Watch(stop, pause, check, report);
      }) {}

}  // namespace ricochet::server
