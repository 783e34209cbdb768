// Options: everything about a server that can be set.
//
// Each option comes from the first of: its flag (--max-live-calls 10), the environment (RICOCHETD_MAX_LIVE_CALLS=10; an
// empty one counts as unset), the file of --config or RICOCHETD_CONFIG (a line max-live-calls = 10, TOML or INI), its
// default.

#ifndef RICOCHET_SERVER_OPTIONS_H_
#define RICOCHET_SERVER_OPTIONS_H_

#include <chrono>
#include <cstdint>
#include <string>
#include <variant>

#include "absl/status/statusor.h"
#include "server/listen_address.h"
#include "server/log.h"

namespace ricochet::server {

struct Options {
  ListenAddress listen = {.host = "127.0.0.1", .port = 50051};
  std::string port_file;  // Where the bound port is written once the server takes calls; empty: nowhere.
  bool insecure = false;  // Required to listen on anything but loopback: nothing is encrypted.

  int max_live_calls = 256;                       // 1 to 65,536.
  int max_threads = 288;                          // At least max_live_calls + kSpareThreads.
  int64_t max_points_per_sweep = 10'000'000'000;  // 1 to 2^53.

  LogFormat log_format = LogFormat::kText;
  LogLevel log_level = LogLevel::kInfo;

  std::chrono::milliseconds drain_grace{3000};     // From health NOT_SERVING to the end of running sweeps; 0 to 1 h.
  std::chrono::milliseconds drain_timeout{20000};  // From there to the end of all calls; 0 to 1 h.

  // Threads that wait for calls or serve reflection. With that many to spare it is the limit on live calls that
  // refuses, with its retry delay, and not gRPC.
  static constexpr int kSpareThreads = 32;

  friend bool operator==(const Options&, const Options&) = default;
};

// A text that was asked for instead of a server: --help, --version.
struct Notice {
  std::string text;
};

// Errors: INVALID_ARGUMENT that names every option with a bad value, the value and the rule, a line each; or the first
// thing that is not an option.
absl::StatusOr<std::variant<Options, Notice>> ParseCommandLine(int argc, const char* const* argv);

}  // namespace ricochet::server

#endif  // RICOCHET_SERVER_OPTIONS_H_
