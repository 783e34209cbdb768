// Call: the frame around the work of every handler. It takes a place among the live calls, measures the time, gathers
// what is known of the call and hands it to the observer at the end.

#ifndef RICOCHET_SERVER_CALL_H_
#define RICOCHET_SERVER_CALL_H_

#include <grpcpp/server_context.h>
#include <grpcpp/support/status.h>

#include <chrono>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "ricochet/call_options.h"
#include "server/admission.h"
#include "server/call_record.h"
#include "server/observer.h"

namespace ricochet::server {

class Call {
 public:
  // Starts the clock, asks for admission and adds the request id to the metadata of the answer. `method` is the method's
  // name without that of the service. All arguments by reference must outlive the call.
  Call(const char* method, grpc::ServerContext& context, Admission& admission, const Observer& observer);
  // Gives the place back and then hands the record to the observer.
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

  // Handlers add to it what they learn of the call: points, chunks, models, the time in the queue.
  CallRecord& record() { return record_; }

  // Records the status as the caller sees it and returns what the handler must return.
  grpc::Status Finish(const absl::Status& status);

 private:
  const std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  const grpc::ServerContext& context_;
  const Observer& observer_;
  absl::StatusOr<Admission::Ticket> ticket_;
  // The status UNKNOWN stays if a handler throws and never finishes; gRPC then answers the same.
  CallRecord record_;
};

}  // namespace ricochet::server

#endif  // RICOCHET_SERVER_CALL_H_
