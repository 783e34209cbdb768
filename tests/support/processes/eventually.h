// Waiting for what another thread or process is about to do.

#ifndef RICOCHET_TESTS_SUPPORT_PROCESSES_EVENTUALLY_H_
#define RICOCHET_TESTS_SUPPORT_PROCESSES_EVENTUALLY_H_

#include <chrono>
#include <functional>
#include <thread>

namespace ricochet {

// Asks again and again until `condition` holds. Returns false if it does not within 30 s, which is far longer than any
// test should take.
inline bool Eventually(const std::function<bool()>& condition,
                       std::chrono::milliseconds pause = std::chrono::milliseconds(1)) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(30);
  while (!condition()) {
    if (std::chrono::steady_clock::now() > end) return false;
    std::this_thread::sleep_for(pause);
  }
  return true;
}

}  // namespace ricochet

#endif  // RICOCHET_TESTS_SUPPORT_PROCESSES_EVENTUALLY_H_
