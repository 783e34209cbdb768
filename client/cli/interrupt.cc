#include "client/cli/interrupt.h"

#include <csignal>
#include <ctime>

namespace ricochet::cli {
namespace {

constexpr timespec kLook = {.tv_sec = 0, .tv_nsec = 20'000'000};

sigset_t Watched() {
  sigset_t signals;
  sigemptyset(&signals);
  sigaddset(&signals, SIGINT);
  sigaddset(&signals, SIGTERM);
  return signals;
}

}  // namespace

Interrupt::Interrupt() {
  const sigset_t signals = Watched();
  pthread_sigmask(SIG_BLOCK, &signals, nullptr);
  watcher_ = std::jthread([source = source_, signals](const std::stop_token& done) mutable {
    while (!done.stop_requested()) {
      if (sigtimedwait(&signals, nullptr, &kLook) > 0) source.request_stop();
    }
  });
}

}  // namespace ricochet::cli
