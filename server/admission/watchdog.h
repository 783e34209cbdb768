// Watchdog: checks again and again, on a thread of its own, whether the server can serve, and reports each change.

#ifndef RICOCHET_SERVER_ADMISSION_WATCHDOG_H_
#define RICOCHET_SERVER_ADMISSION_WATCHDOG_H_

#include <chrono>
#include <functional>
#include <stop_token>
#include <thread>

#include "absl/status/status.h"

namespace ricochet::server {

class Watchdog {
 public:
  // Returns OK, or why the server cannot serve. It must return soon once the token is requested to stop.
  using Check = std::function<absl::Status(const std::stop_token&)>;
  // Learns the result of a check that differs from the one before it; the server counts as good at the start.
  using Report = std::function<void(const absl::Status&)>;

  // Starts to check, with a pause before each check. Both functions run on the thread of the watchdog.
  Watchdog(std::chrono::milliseconds pause, Check check, Report report);

  // Stops to check and waits for the check that runs. `report` is not called any more.
  ~Watchdog() = default;
  Watchdog(const Watchdog&) = delete;
  Watchdog& operator=(const Watchdog&) = delete;

 private:
  std::jthread thread_;
};

}  // namespace ricochet::server

#endif  // RICOCHET_SERVER_ADMISSION_WATCHDOG_H_
