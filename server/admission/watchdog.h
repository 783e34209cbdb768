// The watchdog checks again and again, on a thread of its own, whether the server can serve, and reports each change.

#ifndef RICOCHET_SERVER_ADMISSION_WATCHDOG_H_
#define RICOCHET_SERVER_ADMISSION_WATCHDOG_H_

#include <chrono>
#include <functional>
#include <stop_token>
#include <thread>

#include "absl/status/status.h"

namespace ricochet::server {

// Starts to check, with a pause before each check. `check` returns OK, or why the server cannot serve; it must return
// soon once its token is requested to stop. `report` learns the result of a check that differs from the one before it;
// the server counts as good at the start. Both run on the thread. Its destruction waits for the check that runs, after
// which `report` is not called any more.
std::jthread StartWatchdog(std::chrono::milliseconds pause, std::function<absl::Status(const std::stop_token&)> check,
                           std::function<void(const absl::Status&)> report);

}  // namespace ricochet::server

#endif  // RICOCHET_SERVER_ADMISSION_WATCHDOG_H_
