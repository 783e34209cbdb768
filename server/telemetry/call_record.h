// CallRecord: what the server knows of one call. The call's frame fills it in, and the observer reads it at the end.

#ifndef RICOCHET_SERVER_TELEMETRY_CALL_RECORD_H_
#define RICOCHET_SERVER_TELEMETRY_CALL_RECORD_H_

#include <grpcpp/server_context.h>

#include <array>
#include <cstdint>
#include <optional>
#include <string>

#include "absl/status/status.h"
#include "ricochet/plan.h"

namespace ricochet::server {

struct CallRecord {
  std::string method;      // Name of the method without that of the service, such as "Solve".
  std::string peer;        // Address of the caller, or of the proxy in front of it, as gRPC spells it.
  std::string user_agent;  // Empty if the caller sent none.
  std::string request_id;  // From the caller's metadata x-request-id, or made here.
  std::string trace_id;    // 32 hexadecimal digits of the caller's W3C traceparent; empty if it sent no valid one.

  // The status as the caller saw it, as far as a server can know: CANCELLED or DEADLINE_EXCEEDED if the caller had
  // given up before the answer was complete.
  absl::StatusCode status = absl::StatusCode::kUnknown;
  std::string reason;   // Why the call failed, as a name in upper case; empty if there is none to name.
  std::string message;  // The message of the status that the handler ended with; empty if it was OK.

  double duration_s = 0.0;  // From the start of the handler to its end, the time in the queue included.
  double queued_s = 0.0;    // Time spent waiting for a place to compute.

  std::optional<int64_t> points;  // Points computed; absent if the method has none.
  int64_t first_index = 0;        // Index of the first point asked for; above 0 if a sweep goes on where one broke off.
  int64_t chunks = 0;             // Messages sent, and the bytes in them; both 0 for a method with a single answer.
  int64_t chunk_bytes = 0;
  int64_t received_bytes = 0;  // Bytes of the request's message, and of all messages of the answer.
  int64_t sent_bytes = 0;
  int64_t stalls = 0;      // Waits for the caller to read that were longer than the server tolerates for free.
  double stalled_s = 0.0;  // Time that these waits took.

  // Valid impacts solved, indexed by the number of the model that the plan picked.
  std::array<int64_t, kModelCount> solved_by_model = {};
};

// Returns the record of a call that begins: its method and what its metadata say of the caller. A call without a valid
// request id gets a new one.
CallRecord RecordOf(std::string method, const grpc::ServerContextBase& context);

// Returns the path of a method of the ImpactService: "/ricochet.v1.ImpactService/Solve".
std::string PathOf(const std::string& method);

}  // namespace ricochet::server

#endif  // RICOCHET_SERVER_TELEMETRY_CALL_RECORD_H_
