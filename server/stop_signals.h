// StopSignals: SIGTERM and SIGINT, waited for by a thread instead of handled.
//
// Nothing that stops a server may be called from a signal handler. Threads inherit the blocked signals, so construct
// it before the first one starts.

#ifndef RICOCHET_SERVER_STOP_SIGNALS_H_
#define RICOCHET_SERVER_STOP_SIGNALS_H_

#include <chrono>
#include <csignal>
#include <string>

namespace ricochet::server {

class StopSignals {
 public:
  // Blocks them in this thread and ignores SIGPIPE: a log reader that ends must not end the server.
  StopSignals();

  // Waits for one; its name.
  std::string Wait() const;

  // Waits for one at most `time`; whether it came.
  bool WaitFor(std::chrono::milliseconds time) const;

 private:
  sigset_t set_ = {};
};

}  // namespace ricochet::server

#endif  // RICOCHET_SERVER_STOP_SIGNALS_H_
