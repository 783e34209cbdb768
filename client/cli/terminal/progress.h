// Progress: a bar on the terminal that shows the rate and the time left.

#ifndef RICOCHET_CLIENT_CLI_TERMINAL_PROGRESS_H_
#define RICOCHET_CLIENT_CLI_TERMINAL_PROGRESS_H_

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <string>

namespace ricochet::cli {

// Returns "[#####     ]  50 %   2.5e+06 points/s   3 s left" in at most `width` columns; `unit` names what is counted.
std::string ProgressLine(int64_t done, int64_t total, double seconds, size_t width = 80,
                         const std::string& unit = "points");

// Draws on stderr at most ten times a second if stderr is a terminal, and erases the bar at the end. Otherwise it does
// nothing, and also if `rows_to_terminal`: rows on standard output would then stand between the bars.
class Progress {
 public:
  explicit Progress(bool rows_to_terminal = false, std::string unit = "points");
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  // Erases the bar of any object of this class, before something else is written or the process ends.
  static void Erase();

  void Update(int64_t done, int64_t total);
  double Seconds() const;

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point start_ = Clock::now();
  Clock::time_point drawn_ = start_;
  std::string unit_;
  bool is_shown_;
};

}  // namespace ricochet::cli

#endif  // RICOCHET_CLIENT_CLI_TERMINAL_PROGRESS_H_
