#include "client/cli/terminal/interrupt.h"

#include <unistd.h>

#include <atomic>
#include <chrono>
#include <csignal>

#include "client/cli/io/output.h"
#include "client/cli/terminal/progress.h"

namespace ricochet::cli {
namespace {

constexpr timespec kLook = {.tv_sec = 0, .tv_nsec = 20'000'000};
// A signal that comes again this soon is the same request: timeout(1) sends each signal twice.
constexpr std::chrono::milliseconds kRepeated(500);

std::atomic<bool> happened = false;

sigset_t Watched() {
  sigset_t signals;
  sigemptyset(&signals);
  sigaddset(&signals, SIGINT);
  sigaddset(&signals, SIGTERM);
  return signals;
}

}  // namespace

bool Interrupt::Happened() { return happened; }

void Interrupt::Wait() { happened.wait(false); }

void Interrupt::EndAtSignals() {
  const auto end = [](int /*signal*/) {
    constexpr char kText[] = "ricochet: interrupted\n";
    // The process ends in any case, so that a failed write is ignored.
    [[maybe_unused]] const ssize_t written = write(STDERR_FILENO, kText, sizeof(kText) - 1);
    _exit(kInterruptedExitCode);
  };
  for (const int number : {SIGINT, SIGTERM}) {
    // A shell ignores Ctrl-C for a program that it starts in the background.
    if (std::signal(number, end) == SIG_IGN) std::signal(number, SIG_IGN);
  }
}

Interrupt::Interrupt() {
  StopWritingWhen(&Interrupt::Happened);
  const sigset_t signals = Watched();
  pthread_sigmask(SIG_BLOCK, &signals, nullptr);
  watcher_ = std::jthread([source = source_, signals](const std::stop_token& done) mutable {
    std::chrono::steady_clock::time_point first;
    while (!done.stop_requested()) {
      if (sigtimedwait(&signals, nullptr, &kLook) <= 0) continue;
      const auto now = std::chrono::steady_clock::now();
      if (happened && now - first > kRepeated) {
        Progress::Erase();
        _exit(kInterruptedExitCode);
      }
      if (!happened.exchange(true)) first = now;
      happened.notify_all();
      source.request_stop();
    }
  });
}

}  // namespace ricochet::cli
