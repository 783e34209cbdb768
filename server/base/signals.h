// Signals: which signals the server answers, and how. A thread waits for them, because a signal handler must not call
// anything that stops a server.
//
//   SIGTERM, SIGINT, SIGQUIT                    stop the server; a second one ends its drain at once
//   SIGHUP                                      reopens files: the log, certificates
//   SIGPIPE, SIGALRM, SIGUSR1, SIGUSR2, SIGXFSZ are ignored; each would kill a process that does not handle it
//
// Threads inherit the set of blocked signals, so construct this object before the first thread starts.

#ifndef RICOCHET_SERVER_BASE_SIGNALS_H_
#define RICOCHET_SERVER_BASE_SIGNALS_H_

#include <chrono>
#include <csignal>
#include <functional>
#include <string>

namespace ricochet::server {

class Signals {
 public:
  Signals();

  // Waits for a signal that stops the server and returns its name. Calls `hang_up` on this thread for each SIGHUP.
  std::string WaitForStop(const std::function<void()>& hang_up) const;

  // Waits for a signal that stops the server for at most `time`, at once if `time` <= 0. Returns true if one came.
  bool WaitForStop(std::chrono::nanoseconds time) const;

 private:
  sigset_t stops_ = {};
  sigset_t all_ = {};  // stops_ and SIGHUP.
};

}  // namespace ricochet::server

#endif  // RICOCHET_SERVER_BASE_SIGNALS_H_
