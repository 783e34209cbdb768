#include "client/cli/terminal/progress.h"

#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cstdio>
#include <string_view>
#include <utility>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"

namespace ricochet::cli {
namespace {

constexpr std::chrono::milliseconds kBetweenDraws{100};

std::atomic<bool> visible = false;

// The columns that a line may take. The last one stays free, because some terminals go on in the next line behind it.
size_t Columns() {
  winsize size = {};
  const bool is_known = ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0;
  return (is_known ? size.ws_col : 80U) - 1;
}

}  // namespace

std::string ProgressLine(int64_t done, int64_t total, double seconds, size_t width, const std::string& unit) {
  constexpr size_t kLeastBar = 5;
  constexpr size_t kMostBar = 40;
  const double part = total > 0 ? static_cast<double>(done) / static_cast<double>(total) : 1.0;
  const double rate = seconds > 0.0 ? static_cast<double>(done) / seconds : 0.0;
  const double left = rate > 0.0 ? static_cast<double>(total - done) / rate : 0.0;
  const std::string words = absl::StrFormat("%3.0f %%   %.3g %s/s   %.0f s left", 100.0 * part, rate, unit, left);
  const size_t brackets = std::string_view("[] ").size();
  if (width < words.size() + brackets + kLeastBar) return words.substr(0, width);
  const size_t bar = std::min(kMostBar, width - words.size() - brackets);
  const auto filled = static_cast<size_t>(part * static_cast<double>(bar));
  return absl::StrCat("[", std::string(filled, '#'), std::string(bar - filled, ' '), "] ", words);
}

Progress::Progress(bool rows_to_terminal, std::string unit)
    : unit_(std::move(unit)),
      is_shown_(isatty(STDERR_FILENO) == 1 && !(rows_to_terminal && isatty(STDOUT_FILENO) == 1)) {}

Progress::~Progress() { Erase(); }

void Progress::Erase() {
  if (visible.exchange(false)) std::fputs("\r\x1b[K", stderr);
}

void Progress::Update(int64_t done, int64_t total) {
  const Clock::time_point now = Clock::now();
  if (!is_shown_ || now - drawn_ < kBetweenDraws) return;
  drawn_ = now;
  visible = true;
  std::fprintf(stderr, "\r%s\x1b[K", ProgressLine(done, total, Seconds(), Columns(), unit_).c_str());
}

double Progress::Seconds() const { return std::chrono::duration<double>(Clock::now() - start_).count(); }

}  // namespace ricochet::cli
