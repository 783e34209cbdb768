// ClientOptions: how a Client reaches its server, how long it waits and how often it tries.

#ifndef RICOCHET_CLIENT_OPTIONS_H_
#define RICOCHET_CLIENT_OPTIONS_H_

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "ricochet/security_options.h"

namespace ricochet {

// Says how a call is repeated that failed with UNAVAILABLE, with RESOURCE_EXHAUSTED and a time after which to retry, or
// with a CANCELLED that the caller did not ask for. The wait before attempt n is random between 0 and
// min(initial_backoff * multiplier^(n-2), max_backoff), and at least the time that the server asked for; if that is
// more than a minute, the call fails instead.
struct RetryPolicy {
  // In [1, 5], including the first attempt, for each server; 1 means no retry.
  int max_attempts = 3;
  // A sweep that has begun is taken up again by another call at most this often in a row without a new point; UNKNOWN
  // and INTERNAL, as proxies report a dead server, are reasons too. >= 0; 0 means never. By default a server may be
  // away for some 20 s, which its drain and a start take.
  int max_resumes = 20;
  std::chrono::milliseconds initial_backoff{100};  // > 0, at most a year, as all times.
  std::chrono::milliseconds max_backoff{2000};     // >= initial_backoff.
  double multiplier = 2.0;                         // >= 1.
};

// Says how all servers of a list compute one sweep together: each a range of points at a time, the faster ones longer
// ranges. A server that fails is left alone for a while and its range goes to another one. The sweep fails once every
// server of the list has failed in a row as often as RetryPolicy allows.
struct FanOut {
  // Bytes of values and regimes that may wait in the client until the points before them have arrived, > 0. A server
  // that is further ahead waits. One message of each server comes on top.
  int64_t buffer_bytes = int64_t{64} << 20;
  // If the caller has waited this long for the next point, a second server is asked for it, too, and the first that
  // answers goes on. > 0. A server sends a chunk at least each second, unless one point takes longer.
  std::chrono::milliseconds slow_after{5000};
};

// gRPC counts the bytes of a message in 32 bits.
inline constexpr int64_t kMostReceiveBytes = (int64_t{1} << 31) - 1;

// Says how a Client reaches its server. Only `target` is required.
struct ClientOptions {
  // "host:port" or another gRPC target, such as "unix:PATH". Required. A list, separated by commas, names servers that
  // stand in for each other: calls go to the first; where it fails, they and those after them go to the next.
  // A server may be named twice, for a `fan_out` over the servers behind one proxy.
  // A host that is not loopback is reached through the HTTP proxy of the environment, if http_proxy names one and
  // no_proxy does not exempt the host.
  std::string target = {};
  std::chrono::milliseconds deadline{10000};                     // For every call with one answer, tries included. > 0.
  std::optional<std::chrono::milliseconds> sweep_deadline = {};  // For a whole stream; absent means none. > 0.
  // Bytes of one message of an answer, in [1, kMostReceiveBytes]. A larger one fails with RESOURCE_EXHAUSTED. A server
  // with its default limits sends none above 4 MiB but the answer of a batch, which a Client asks for in pieces.
  int64_t max_receive_bytes = int64_t{4} << 20;
  RetryPolicy retry = {};
  // Present: the servers of the list compute a sweep together, not one after another.
  std::optional<FanOut> fan_out = {};
  SecurityOptions security = {};
  // Every call puts it before gRPC's own user agent. At most 256 printable ASCII characters.
  std::string user_agent = {};
};

// Checks the rules above. Errors: INVALID_ARGUMENT that names every option that breaks one.
absl::Status ValidateOptions(const ClientOptions& options);

// Returns the servers in `target`, in their order.
std::vector<std::string> Targets(const ClientOptions& options);

// Returns the retry policy of calls with one response as a gRPC service config in JSON. The options must be valid. It
// stops retries while more than one call in ten fails.
std::string ServiceConfig(const ClientOptions& options);

}  // namespace ricochet

#endif  // RICOCHET_CLIENT_OPTIONS_H_
