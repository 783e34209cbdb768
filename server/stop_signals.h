// StopSignals: a thread waits for SIGTERM and SIGINT, because a signal handler must not call what stops a server.
//
// Threads inherit the set of blocked signals, so construct this object before the first thread starts.

#ifndef RICOCHET_SERVER_STOP_SIGNALS_H_
#define RICOCHET_SERVER_STOP_SIGNALS_H_

#include <chrono>
#include <csignal>
#include <string>

namespace ricochet::server {

class StopSignals {
 public:
  // Blocks the two signals in this thread. Also ignores SIGPIPE: a reader of the log that ends must not end the server.
  StopSignals();

  // Waits for a signal and returns its name.
  std::string Wait() const;

  // Waits for a signal for at most `time`. Returns true if one came.
  bool WaitFor(std::chrono::milliseconds time) const;

 private:
  sigset_t set_ = {};
};

}  // namespace ricochet::server

#endif  // RICOCHET_SERVER_STOP_SIGNALS_H_
