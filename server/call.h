// Call: the frame around the work of every handler. It takes a place among the live calls, measures the time and writes
// one log line at the end.

#ifndef RICOCHET_SERVER_CALL_H_
#define RICOCHET_SERVER_CALL_H_

#include <grpcpp/server_context.h>
#include <grpcpp/support/status.h>

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "ricochet/call_options.h"
#include "server/admission.h"
#include "server/log.h"

namespace ricochet::server {

class Call {
 public:
  // Starts the clock and asks for admission. `method` is the method's name without that of the service.
  Call(const char* method, const grpc::ServerContext& context, Admission& admission, const Log& log);
  // Writes the log line.
  ~Call();
  Call(const Call&) = delete;
  Call& operator=(const Call&) = delete;

  // OK, or the error with which the handler must finish at once.
  absl::Status admitted() const { return ticket_.status(); }

  // Returns the seconds since the start.
  double elapsed_s() const;

  // Returns the options of the solver's call: it ends at the client's deadline, and when the client cancels or vanishes.
  // The context must outlive them.
  CallOptions options() const;

  // Sets the number of points of a sweep computed so far, for the log line.
  void set_points(int64_t points) { points_ = points; }

  // Records the status for the log line and returns what the handler must return.
  grpc::Status Finish(const absl::Status& status);

 private:
  const std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  const grpc::ServerContext& context_;
  const Log& log_;
  const std::string method_;
  const std::string peer_;
  const absl::StatusOr<Admission::Ticket> ticket_;
  std::optional<int64_t> points_;
  // The status UNKNOWN is logged if a handler throws and never finishes; gRPC then answers the same.
  absl::StatusCode code_ = absl::StatusCode::kUnknown;
};

}  // namespace ricochet::server

#endif  // RICOCHET_SERVER_CALL_H_
