// Options: all settings of a server.
//
// The value of an option is taken from the first of these that sets it: its flag (--max-live-calls 10), the environment
// (RICOCHETD_MAX_LIVE_CALLS=10), the file of --config or RICOCHETD_CONFIG (a line max-live-calls = 10, TOML or INI),
// its default. An empty value is refused wherever it stands.

#ifndef RICOCHET_SERVER_OPTIONS_H_
#define RICOCHET_SERVER_OPTIONS_H_

#include <sys/types.h>

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "absl/status/statusor.h"
#include "ricochet/info.h"
#include "ricochet/limits.h"
#include "server/admission/live_calls.h"
#include "server/base/cpu_quota.h"
#include "server/base/listen_address.h"
#include "server/base/log.h"
#include "server/calls/call.h"
#include "server/security/tls_files.h"
#include "server/telemetry/call_rule.h"
#include "server/transport/connection_counts.h"
#include "server/transport/transport.h"

namespace CLI {
class App;
}

namespace ricochet::server {

struct Options {
  std::vector<ListenAddress> listen = {{.host = "127.0.0.1", .port = 50051, .path = ""}};  // At least one.
  std::vector<ListenAddress> reflection;  // Where clients can read the proto files; empty: nowhere.
  mode_t socket_mode = 0600;              // Permissions of the file of a Unix socket; 0 to 0777.
  std::optional<ListenAddress> metrics;   // Where Prometheus can read the metrics; absent: nowhere.
  std::string port_file;  // The bound port is written to this file once the server takes calls; empty: to no file.
  bool insecure = false;  // Required to listen beyond loopback and Unix sockets without TLS.

  TlsPaths tls;        // Empty paths: no TLS.
  std::string tokens;  // The file of callers; empty: whoever can connect may call everything.

  ConnectionLimits connections;        // Each limit from 1 to 1,000,000.
  int64_t transport_memory_mib = 256;  // For gRPC's buffers of all connections together; 1 to 1,048,576.
  // Limits the memory of the requests and answers of all calls; from LeastCallMemoryMib(limits) to 1,048,576.
  int64_t call_memory_mib = 512;
  TransportTimes transport_times;  // Each 1 ms to 1 h.

  // Threads that wait for calls or tell callers that they are refused. With this many spare threads an overload is
  // refused by the limit of live calls, which sends a retry delay, and not by gRPC.
  static constexpr int kSpareThreads = 128;
  LiveCallLimits live_calls = LiveCallLimitsFor(1024);       // Each limit from 1 to 65,536.
  int max_threads = 1024 + kSpareThreads;                    // At least live_calls.calls + kSpareThreads.
  int compute_threads = CoresWithinQuota(AvailableCores());  // 1 to 1024.
  int max_waiting_calls = 256;                               // Expensive unary calls that wait to compute; 1 to 65,536.
  TimeLimits time_limits;                                    // 1 ms to 1 h.
  std::chrono::milliseconds unread_limit{30'000};            // 1 ms to 1 h.

  Limits limits;  // How large a request may be: one option for each of kLimits.

  LogFormat log_format = LogFormat::kText;
  LogLevel log_level = LogLevel::kInfo;
  std::string log_file;  // Empty: standard error.
  CallRule log_calls;

  std::chrono::milliseconds drain_grace{3000};    // From health NOT_SERVING to the end of running sweeps; 0 to 1 h.
  std::chrono::milliseconds drain_timeout{5000};  // From there to the stop of all calls; 0 to 1 h.

  friend bool operator==(const Options&, const Options&) = default;
};

// Returns the least memory of which one client's share, three quarters, holds the largest batch with its answer, and at
// least 32 MiB, because any other request with its answer takes less.
int64_t LeastCallMemoryMib(const Limits& limits);

// A text that the user asked for instead of a server: --help, --version.
struct Notice {
  std::string text;
};

// Reads the options of a server.
// Errors: INVALID_ARGUMENT with one line for each bad value, which names the option, the value and the rule; or
// INVALID_ARGUMENT that names the first argument that is not an option.
absl::StatusOr<std::variant<Options, Notice>> ParseCommandLine(int argc, const char* const* argv);

// Returns the command line that ParseCommandLine reads, for programs that describe it.
std::unique_ptr<CLI::App> MakeCommandLine();

// The limits of a server beyond those of a request's size, as clients ask for them and the log states them.
ServerLimits ServerLimitsOf(const Options& options);

}  // namespace ricochet::server

#endif  // RICOCHET_SERVER_OPTIONS_H_
