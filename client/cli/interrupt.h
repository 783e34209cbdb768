// Interrupt: Ctrl-C and SIGTERM as a stop token, so that a run ends in order and leaves nothing half-written.

#ifndef RICOCHET_CLIENT_CLI_INTERRUPT_H_
#define RICOCHET_CLIENT_CLI_INTERRUPT_H_

#include <stop_token>
#include <thread>

namespace ricochet::cli {

// Make it before any other thread: threads inherit that the signals wait for this one.
class Interrupt {
 public:
  Interrupt();
  std::stop_token token() const { return source_.get_token(); }

 private:
  std::stop_source source_;
  std::jthread watcher_;
};

}  // namespace ricochet::cli

#endif  // RICOCHET_CLIENT_CLI_INTERRUPT_H_
