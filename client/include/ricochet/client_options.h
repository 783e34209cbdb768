// ClientOptions: how a Client reaches its server, how long it waits and how often it tries.

#ifndef RICOCHET_CLIENT_OPTIONS_H_
#define RICOCHET_CLIENT_OPTIONS_H_

#include <chrono>
#include <optional>
#include <string>

#include "absl/status/status.h"
#include "ricochet/security_options.h"

namespace ricochet {

// How a call is repeated that failed with UNAVAILABLE before its first response. The wait before attempt n is random
// between 0 and min(initial_backoff * multiplier^(n-2), max_backoff).
struct RetryPolicy {
  int max_attempts = 3;                            // In [1, 5], including the first attempt; 1 means no retry.
  std::chrono::milliseconds initial_backoff{100};  // > 0.
  std::chrono::milliseconds max_backoff{2000};     // >= initial_backoff.
  double multiplier = 2.0;                         // >= 1.
};

// How a Client reaches its server. Only `target` is required.
struct ClientOptions {
  std::string target;                         // "host:port" or another gRPC target, such as "unix:PATH". Required.
  std::chrono::milliseconds deadline{10000};  // For Solve, Bounds and CheckHealth, tries included. > 0.
  std::optional<std::chrono::milliseconds> sweep_deadline;  // For a whole stream; absent means none. > 0.
  RetryPolicy retry;
  SecurityOptions security;
  std::string user_agent;  // Text that every call puts before gRPC's own user agent.
};

// Checks the rules above. Errors: INVALID_ARGUMENT that names every option that breaks one.
absl::Status ValidateOptions(const ClientOptions& options);

// Returns the retry policy as a gRPC service config in JSON. The options must be valid.
std::string ServiceConfig(const ClientOptions& options);

}  // namespace ricochet

#endif  // RICOCHET_CLIENT_OPTIONS_H_
