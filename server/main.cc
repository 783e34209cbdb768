// ricochetd: the impact service as a daemon. Exit codes: 0 after a signal and an orderly shutdown, 1 if it cannot
// start, 2 for bad options.

#include <fcntl.h>
#include <malloc.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <iostream>
#include <string>
#include <thread>
#include <utility>
#include <variant>

#include "absl/synchronization/mutex.h"
#include "server/base/log.h"
#include "server/base/log_writer.h"
#include "server/base/signals.h"
#include "server/options.h"
#include "server/server.h"
#include "server/start_fields.h"

namespace {

// The time at the end for lines of the log that are not yet written; a log that nobody reads keeps some for ever.
constexpr std::chrono::seconds kTimeForLog(1);

// Opens what is closed of standard input, output and error, so that no socket gets their numbers and what is written
// there.
void OpenStandardDescriptors() {
  int descriptor = 0;
  do {
    descriptor = open("/dev/null", O_RDWR);
  } while (descriptor >= STDIN_FILENO && descriptor <= STDERR_FILENO);
  if (descriptor > STDERR_FILENO) close(descriptor);
}

// Makes glibc return the memory of large requests. It would share the memory out to eight arenas a core, and serve ever
// larger blocks from them, which stay once requests of all sizes have been mixed in them.
void BoundKeptMemory() {
  constexpr int kLargeBlock = 1 << 20;
  constexpr int kMostKeptInAnArena = 8 << 20;
  mallopt(M_ARENA_MAX, 2 * static_cast<int>(std::clamp(std::thread::hardware_concurrency(), 1U, 1024U)));
  mallopt(M_MMAP_THRESHOLD, kLargeBlock);
  mallopt(M_TRIM_THRESHOLD, kMostKeptInAnArena);
}

int Run(int argc, const char* const* argv) {
  namespace server = ricochet::server;
  BoundKeptMemory();
  OpenStandardDescriptors();
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
  auto writer = server::LogWriter::Open(options.log_file);
  if (!writer.ok()) {
    std::cerr << "ricochetd: " << writer.status().message() << '\n';
    return 1;
  }
  const server::Log log(options.log_format, options.log_level, *std::move(writer));
  log.Write(server::LogLevel::kInfo, "starting", server::StartFields(options));
  const auto running = server::Server::Start(options, log);
  if (!running.ok()) {
    log.Write(server::LogLevel::kError, "cannot start", {{"reason", std::string(running.status().message())}});
    return 1;
  }
  (*running)->AtHangUp([&log] { log.Reopen().IgnoreError(); });
  (*running)->ServeUntil(signals);
  log.Flush(kTimeForLog);
  // All calls have ended or used up their time. The exit closes their connections; destroying the server would wait for
  // clients that have stopped reading.
  std::_Exit(0);
}

}  // namespace

int main(int argc, char** argv) {
  // A build of abseil with assertions reports the lock order inside gRPC as a potential deadlock.
  absl::SetMutexDeadlockDetectionMode(absl::OnDeadlockCycle::kIgnore);
  return Run(argc, argv);
}
