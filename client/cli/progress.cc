#include "client/cli/progress.h"

#include <unistd.h>

#include <cstdio>
#include <utility>

#include "absl/strings/str_format.h"

namespace ricochet::cli {
namespace {

constexpr int kBarWidth = 40;
constexpr std::chrono::milliseconds kBetweenDraws{100};

}  // namespace

std::string ProgressLine(int64_t done, int64_t total, double seconds, const std::string& unit) {
  const double part = total > 0 ? static_cast<double>(done) / static_cast<double>(total) : 1.0;
  const double rate = seconds > 0.0 ? static_cast<double>(done) / seconds : 0.0;
  const double left = rate > 0.0 ? static_cast<double>(total - done) / rate : 0.0;
  const auto filled = static_cast<size_t>(part * kBarWidth);
  return absl::StrFormat("[%s%s] %3.0f %%   %.3g %s/s   %.0f s left", std::string(filled, '#'),
                         std::string(kBarWidth - filled, ' '), 100.0 * part, rate, unit, left);
}

Progress::Progress(std::string unit) : unit_(std::move(unit)), terminal_(isatty(STDERR_FILENO) == 1) {}

Progress::~Progress() {
  if (visible_) std::fputs("\r\x1b[K", stderr);
}

void Progress::Update(int64_t done, int64_t total) {
  const Clock::time_point now = Clock::now();
  if (!terminal_ || now - drawn_ < kBetweenDraws) return;
  drawn_ = now;
  visible_ = true;
  std::fprintf(stderr, "\r%s\x1b[K", ProgressLine(done, total, Seconds(), unit_).c_str());
}

double Progress::Seconds() const { return std::chrono::duration<double>(Clock::now() - start_).count(); }

}  // namespace ricochet::cli
