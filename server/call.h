// Call: what surrounds the work of every handler. A place among the live calls, the time, one log line at the end.

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
#include "server/admission.h"
#include "server/log.h"

namespace ricochet::server {

class Call {
 public:
  // Starts the clock and asks for admission. `method` is the method's name within the service.
  Call(const char* method, const grpc::ServerContext& context, Admission& admission, const Log& log);
  // Writes the log line.
  ~Call();
  Call(const Call&) = delete;
  Call& operator=(const Call&) = delete;

  // OK, or why the handler must do nothing but finish with it.
  absl::Status admitted() const { return ticket_.status(); }

  // Seconds since the start.
  double elapsed_s() const;

  // Points of a sweep computed so far, for the log line.
  void set_points(int64_t points) { points_ = points; }

  // What the handler returns.
  grpc::Status Finish(const absl::Status& status);

 private:
  const std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  const Log& log_;
  const std::string method_;
  const std::string peer_;
  const absl::StatusOr<Admission::Ticket> ticket_;
  std::optional<int64_t> points_;
  // What gRPC answers if a handler throws and so never finishes.
  absl::StatusCode code_ = absl::StatusCode::kUnknown;
};

}  // namespace ricochet::server

#endif  // RICOCHET_SERVER_CALL_H_
