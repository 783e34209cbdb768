#include "server/start_fields.h"

#include <algorithm>
#include <cstdint>
#include <string>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "ricochet/engine_info.h"
#include "ricochet/limits.h"
#include "server/base/listen_address.h"
#include "server/server_limits.h"

namespace ricochet::server {

namespace {

// Returns how the caller's requests travel.
std::string SecurityOf(const Options& options) {
  const char* const tokens = options.tokens.empty() ? "" : ", tokens";
  if (!options.tls.client_ca.empty()) return absl::StrCat("mutual TLS", tokens);
  if (!options.tls.certificate.empty()) return absl::StrCat("TLS", tokens);
  const bool on_this_host = std::all_of(options.listen.begin(), options.listen.end(), IsLocal);
  return absl::StrCat(on_this_host ? "plaintext on this host" : "plaintext beyond this host", tokens);
}

}  // namespace

std::vector<LogField> StartFields(const Options& options) {
  const std::string addresses = absl::StrJoin(
      options.listen, ",", [](std::string* out, const ListenAddress& address) { *out += ToString(address); });
  std::vector<LogField> fields = {{"version", ThisEngine().version},
                                  {"engine", ThisEngine().fingerprint},
                                  {"listen", addresses},
                                  {"security", SecurityOf(options)},
                                  {"transport_memory_mib", options.transport_memory_mib},
                                  {"max_threads", int64_t{options.max_threads}},
                                  {"compute_threads", int64_t{options.compute_threads}},
                                  {"drain_grace_ms", int64_t{options.drain_grace.count()}},
                                  {"drain_timeout_ms", int64_t{options.drain_timeout.count()}}};
  const ServerLimits limits = ServerLimitsOf(options);
  for (const NamedServerLimit& limit : kServerLimits) fields.push_back({limit.name, limits.*limit.value});
  for (const NamedLimit& limit : kLimits) fields.push_back({limit.name, options.limits.*limit.value});
  return fields;
}

}  // namespace ricochet::server
