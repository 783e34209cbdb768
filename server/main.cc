// ricochetd: the impact service as a daemon. Exit codes: 0 after a signal and an orderly shutdown, 1 if it cannot
// start, 2 for bad options.

#include <fcntl.h>
#include <malloc.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <cstdlib>
#include <iostream>
#include <string>
#include <thread>
#include <utility>
#include <variant>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "absl/synchronization/mutex.h"
#include "ricochet/engine_info.h"
#include "ricochet/limits.h"
#include "server/base/listen_address.h"
#include "server/base/log.h"
#include "server/base/log_writer.h"
#include "server/base/signals.h"
#include "server/options.h"
#include "server/server.h"

namespace ricochet::server {
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

// Returns how the caller's requests travel.
std::string SecurityOf(const Options& options) {
  const char* const tokens = options.tokens.empty() ? "" : ", tokens";
  if (!options.tls.client_ca.empty()) return absl::StrCat("mutual TLS", tokens);
  if (!options.tls.certificate.empty()) return absl::StrCat("TLS", tokens);
  const bool on_this_host = std::all_of(options.listen.begin(), options.listen.end(), IsLocal);
  return absl::StrCat(on_this_host ? "plaintext on this host" : "plaintext beyond this host", tokens);
}

// The fields of the log's first record: which server this is, where it listens and within which limits.
std::vector<LogField> StartFields(const Options& options) {
  const std::string addresses = absl::StrJoin(
      options.listen, ",", [](std::string* out, const ListenAddress& address) { *out += ToString(address); });
  std::vector<LogField> fields = {{"version", ThisEngine().version},
                                  {"engine", ThisEngine().fingerprint},
                                  {"listen", addresses},
                                  {"security", SecurityOf(options)},
                                  {"transport_memory_mib", options.transport_memory_mib},
                                  {"call_memory_mib", options.call_memory_mib},
                                  {"max_threads", int64_t{options.max_threads}},
                                  {"compute_threads", int64_t{options.compute_threads}},
                                  {"drain_grace_ms", int64_t{options.drain_grace.count()}},
                                  {"drain_timeout_ms", int64_t{options.drain_timeout.count()}}};
  const ServerLimits limits = ServerLimitsOf(options);
  for (const NamedServerLimit& limit : kServerLimits) fields.push_back({limit.name, limits.*limit.value});
  for (const NamedLimit& limit : kLimits) fields.push_back({limit.name, options.limits.*limit.value});
  return fields;
}

int Run(int argc, const char* const* argv) {
  BoundKeptMemory();
  OpenStandardDescriptors();
  const Signals signals;

  const auto command = ParseCommandLine(argc, argv);
  if (!command.ok()) {
    std::cerr << "ricochetd: " << command.status().message() << '\n';
    return 2;
  }
  if (const auto* notice = std::get_if<Notice>(&*command)) {
    std::cout << notice->text;
    return 0;
  }

  const auto& options = std::get<Options>(*command);
  auto writer = LogWriter::Open(options.log_file);
  if (!writer.ok()) {
    std::cerr << "ricochetd: " << writer.status().message() << '\n';
    return 1;
  }
  const Log log(options.log_format, options.log_level, *std::move(writer));
  log.Write(LogLevel::kInfo, "starting", StartFields(options));
  const auto running = Server::Start(options, log);
  if (!running.ok()) {
    log.Write(LogLevel::kError, "cannot start", {{"reason", std::string(running.status().message())}});
    return 1;
  }
  (*running)->ServeUntil(signals);
  log.Flush(kTimeForLog);
  // All calls have ended or used up their time. The exit closes their connections; destroying the server would wait for
  // clients that have stopped reading.
  std::_Exit(0);
}

}  // namespace
}  // namespace ricochet::server

int main(int argc, char** argv) {
  // A build of abseil with assertions reports the lock order inside gRPC as a potential deadlock.
  absl::SetMutexDeadlockDetectionMode(absl::OnDeadlockCycle::kIgnore);
  return ricochet::server::Run(argc, argv);
}
