// Transport: the limits and times that gRPC keeps for connections, messages and headers.

#ifndef RICOCHET_SERVER_TRANSPORT_TRANSPORT_H_
#define RICOCHET_SERVER_TRANSPORT_TRANSPORT_H_

#include <grpcpp/server_builder.h>

#include <chrono>
#include <cstdint>

namespace ricochet::server {

// Both > 0.
struct TransportTimes {
  std::chrono::milliseconds handshake{10'000};  // For TLS and the preface of HTTP/2; a slower connection is closed.
  std::chrono::milliseconds idle{300'000};      // A connection that has had no call for so long is closed.
  friend bool operator==(const TransportTimes&, const TransportTimes&) = default;
};

// A request with more metadata is refused. A connection carries at most this number of calls at once.
inline constexpr int kMaxMetadataBytes = 8 << 10;
inline constexpr int kMaxCallsPerConnection = 128;

struct TransportLimits {
  int max_threads = 288;                      // Threads that serve calls and wait for them; at least 2.
  int64_t memory_bytes = int64_t{256} << 20;  // For buffers of messages in all connections together; at least 1 MiB.
  // Bytes of one message, from 1 to 2^30. gRPC refuses a longer one without the server's knowledge.
  int64_t message_bytes = int64_t{1} << 20;
  TransportTimes times;
};

// Sets the limits, keepalive and the ages at which connections end. Compression is off: a message of 1 MB could unfold
// into a gigabyte before its size is known.
void SetTransport(const TransportLimits& limits, grpc::ServerBuilder& builder);

// Leaves the reflection service out, which gRPC otherwise adds to every server of the process.
void LeaveReflectionOut(grpc::ServerBuilder& builder);

}  // namespace ricochet::server

#endif  // RICOCHET_SERVER_TRANSPORT_TRANSPORT_H_
