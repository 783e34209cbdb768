// ricochetd: the impact service as a daemon. Exit codes: 0 after a signal and an orderly shutdown, 1 if it cannot
// start, 2 for bad options.

#include <cstdlib>
#include <iostream>
#include <string>
#include <variant>

#include "absl/synchronization/mutex.h"
#include "server/log.h"
#include "server/options.h"
#include "server/server.h"
#include "server/signals.h"

namespace {

int Run(int argc, const char* const* argv) {
  namespace server = ricochet::server;
  const server::Signals signals;

  const auto command = server::ParseCommandLine(argc, argv);
  if (!command.ok()) {
    std::cerr << "ricochetd: " << command.status().message() << '\n';
    return 2;
  }
  if (const auto* notice = std::get_if<server::Notice>(&*command)) {
    std::cout << notice->text;
    return 0;
  }

  const auto& options = std::get<server::Options>(*command);
  const server::Log log(options.log_format, options.log_level, std::cerr);
  const auto running = server::Server::Start(options, log);
  if (!running.ok()) {
    log.Write(server::LogLevel::kError, "cannot start", {{"reason", std::string(running.status().message())}});
    return 1;
  }
  (*running)->ServeUntil(signals);
  // All calls have ended or used up their time. The exit closes their connections; destroying the server would wait for clients that have stopped reading.
  std::_Exit(0);
}

}  // namespace

int main(int argc, char** argv) {
  // A build of abseil with assertions reports the lock order inside gRPC as a potential deadlock.
  absl::SetMutexDeadlockDetectionMode(absl::OnDeadlockCycle::kIgnore);
  return Run(argc, argv);
}
