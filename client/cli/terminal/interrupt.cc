#include "client/cli/terminal/interrupt.h"

#include <unistd.h>

#include <array>
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

constexpr std::array kSignals = {SIGINT, SIGTERM};

// A shell ignores Ctrl-C for a program that it starts in the background.
bool IsIgnored(int number) {
  struct sigaction action = {};
  return sigaction(number, nullptr, &action) == 0 && action.sa_handler == SIG_IGN;
}

sigset_t Watched() {
  sigset_t signals;
  sigemptyset(&signals);
  for (const int number : kSignals) {
    if (!IsIgnored(number)) sigaddset(&signals, number);
  }
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
  for (const int number : kSignals) {
    if (!IsIgnored(number)) std::signal(number, end);
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
