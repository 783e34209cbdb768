#include "server/server_limits.h"

#include "server/calls/bounded_service.h"
#include "server/transport/transport.h"

namespace ricochet::server {

ServerLimits ServerLimitsOf(const Options& options) {
  return {.max_message_bytes = kMostBytes,
          .max_metadata_bytes = kMaxMetadataBytes,
          .max_calls_per_connection = kMaxCallsPerConnection,
          .max_connections = options.connections.in_all,
          .max_connections_per_peer = options.connections.per_peer,
          .max_live_calls = options.live_calls.calls,
          .max_live_calls_per_peer = options.live_calls.calls_per_peer,
          .max_streams = options.live_calls.streams,
          .max_streams_per_peer = options.live_calls.streams_per_peer,
          .max_waiting_calls = options.max_waiting_calls,
          .max_unary_time_ms = options.time_limits.unary_time.count(),
          .max_stream_age_ms = options.time_limits.stream_age.count(),
          .write_stall_timeout_ms = options.unread_limit.count()};
}

}  // namespace ricochet::server
