#include "server/base/signals.h"

#include <algorithm>
#include <cerrno>

#include "absl/strings/str_cat.h"

namespace ricochet::server {
namespace {

constexpr int kStops[] = {SIGTERM, SIGINT, SIGQUIT};
constexpr int kIgnored[] = {SIGPIPE, SIGALRM, SIGUSR1, SIGUSR2, SIGXFSZ};

}  // namespace

Signals::Signals() {
  sigemptyset(&stops_);
  for (const int stop : kStops) sigaddset(&stops_, stop);
  all_ = stops_;
  sigaddset(&all_, SIGHUP);
  pthread_sigmask(SIG_BLOCK, &all_, nullptr);
  for (const int ignored : kIgnored) std::signal(ignored, SIG_IGN);
}

std::string Signals::WaitForStop(const std::function<void()>& hang_up) const {
  for (;;) {
    int signal = 0;
    if (sigwait(&all_, &signal) != 0) continue;
    if (signal != SIGHUP) return absl::StrCat("SIG", sigabbrev_np(signal));
    hang_up();
  }
}

bool Signals::WaitForStop(std::chrono::nanoseconds time) const {
  const auto end = std::chrono::steady_clock::now() + time;
  for (;;) {
    const auto left = std::max(end - std::chrono::steady_clock::now(), {});
    const auto seconds = std::chrono::floor<std::chrono::seconds>(left);
    const timespec timeout = {.tv_sec = seconds.count(), .tv_nsec = std::chrono::nanoseconds(left - seconds).count()};
    if (sigtimedwait(&stops_, nullptr, &timeout) > 0) return true;
    if (errno != EINTR) return false;
  }
}

}  // namespace ricochet::server
