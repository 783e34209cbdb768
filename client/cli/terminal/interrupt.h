// Interrupt: turns Ctrl-C and SIGTERM into a stop token, so that a run ends in order. The second one ends it at once.

#ifndef RICOCHET_CLIENT_CLI_TERMINAL_INTERRUPT_H_
#define RICOCHET_CLIENT_CLI_TERMINAL_INTERRUPT_H_

#include <stop_token>
#include <thread>

namespace ricochet::cli {

// The exit code of a run that Ctrl-C or SIGTERM ended, which is that of a shell for SIGINT.
inline constexpr int kInterruptedExitCode = 130;

// Construct it before any other thread starts, because threads inherit the set of blocked signals.
class Interrupt {
 public:
  Interrupt();
  std::stop_token token() const { return source_.get_token(); }

  // True if a signal has come, to any object of this class.
  static bool Happened();

  // Waits until a signal has come.
  static void Wait();

  // Makes both signals end the program at once with kInterruptedExitCode, until an object of this class is made.
  static void EndAtSignals();

 private:
  std::stop_source source_;
  std::jthread watcher_;
};

}  // namespace ricochet::cli

#endif  // RICOCHET_CLIENT_CLI_TERMINAL_INTERRUPT_H_
