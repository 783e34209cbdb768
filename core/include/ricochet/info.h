// Info: what a solver computes with, what it can answer, and how large and how long a call may be.
//
// The structs mirror ricochet.v1.InfoRequest and InfoResponse.

#ifndef RICOCHET_INFO_H_
#define RICOCHET_INFO_H_

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "ricochet/engine_info.h"
#include "ricochet/limits.h"
#include "ricochet/plan.h"

namespace ricochet {

struct InfoRequest {
  friend bool operator==(const InfoRequest&, const InfoRequest&) = default;
};

// Says how many calls and connections a server takes at once, how long they may take, and how large their messages may
// be. Each is >= 1.
struct ServerLimits {
  int64_t max_message_bytes = 1;
  int64_t max_metadata_bytes = 1;
  int64_t max_calls_per_connection = 1;
  int64_t max_connections = 1;
  int64_t max_connections_per_peer = 1;
  int64_t max_live_calls = 1;
  int64_t max_live_calls_per_peer = 1;
  int64_t max_streams = 1;
  int64_t max_streams_per_peer = 1;
  int64_t max_waiting_calls = 1;
  int64_t max_unary_time_ms = 1;
  int64_t max_stream_age_ms = 1;
  int64_t write_stall_timeout_ms = 1;

  friend bool operator==(const ServerLimits&, const ServerLimits&) = default;
};

// A limit of a server by name, as the proto and the server's log spell it.
struct NamedServerLimit {
  const char* name;
  int64_t ServerLimits::*value;
  const char* help;  // One line that says what is limited.
};

// Every limit of a server, in the order of the struct.
inline constexpr NamedServerLimit kServerLimits[] = {
    {"max_message_bytes", &ServerLimits::max_message_bytes, "Bytes of a request that is no batch"},
    {"max_metadata_bytes", &ServerLimits::max_metadata_bytes, "Bytes of the metadata of a request"},
    {"max_calls_per_connection", &ServerLimits::max_calls_per_connection, "Calls on one connection at once"},
    {"max_connections", &ServerLimits::max_connections, "Connections open at once"},
    {"max_connections_per_peer", &ServerLimits::max_connections_per_peer, "Connections of one client"},
    {"max_live_calls", &ServerLimits::max_live_calls, "Calls that run or wait at once"},
    {"max_live_calls_per_peer", &ServerLimits::max_live_calls_per_peer, "Calls of one client among them"},
    {"max_streams", &ServerLimits::max_streams, "Sweeps and studies of cost among the live calls"},
    {"max_streams_per_peer", &ServerLimits::max_streams_per_peer, "Those of one client"},
    {"max_waiting_calls", &ServerLimits::max_waiting_calls, "Expensive unary calls that wait to be computed"},
    {"max_unary_time_ms", &ServerLimits::max_unary_time_ms, "The longest that a unary call may take"},
    {"max_stream_age_ms", &ServerLimits::max_stream_age_ms, "The longest that a stream may run"},
    {"write_stall_timeout_ms", &ServerLimits::write_stall_timeout_ms,
     "The longest that a client may leave one message unread"},
};

struct InfoResponse {
  EngineInfo engine;
  Limits limits = Limits::None();             // INT64_MAX does not limit anything.
  std::optional<ServerLimits> server_limits;  // Absent if no server answers.
  bool certified = false;                     // True if certificates can be asked for.
  std::vector<std::string> systems;           // The systems that a scene can have, by name: "pendulum", ...
  std::vector<Model> models;                  // The models that can compute an impact, in the order of their numbers.
  friend bool operator==(const InfoResponse&, const InfoResponse&) = default;
};

}  // namespace ricochet

#endif  // RICOCHET_INFO_H_
