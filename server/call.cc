#include "server/call.h"

#include <string>
#include <utility>

#include "proto/wire/status.h"
#include "ricochet/error.h"
#include "ricochet/v1/error_reason.pb.h"
#include "server/request_id.h"
#include "server/trace_parent.h"

namespace ricochet::server {
namespace {

// Returns the first value that the caller sent under a name, or an empty text.
std::string Metadata(const grpc::ServerContext& context, const char* name) {
  const auto found = context.client_metadata().find(name);
  if (found == context.client_metadata().end()) return "";
  return {found->second.data(), found->second.size()};
}

// Returns the status that the caller sees of a call that ends now with `code`.
absl::StatusCode SeenByCaller(absl::StatusCode code, const grpc::ServerContext& context) {
  if (context.deadline() <= std::chrono::system_clock::now()) return absl::StatusCode::kDeadlineExceeded;
  return context.IsCancelled() ? absl::StatusCode::kCancelled : code;
}

// Returns the reason as it stands in google.rpc.ErrorInfo, or an empty text for none.
std::string NameOf(ErrorReason reason) {
  constexpr size_t kPrefix = sizeof("ERROR_REASON_") - 1;
  if (reason == ErrorReason::kUnspecified) return "";
  return v1::ErrorReason_Name(static_cast<v1::ErrorReason>(reason)).substr(kPrefix);
}

}  // namespace

Call::Call(const char* method, grpc::ServerContext& context, Admission& admission, const Observer& observer)
    : context_(context), observer_(observer), ticket_(admission.Enter()) {
  record_.method = method;
  record_.peer = context.peer();
  record_.user_agent = Metadata(context, "user-agent");
  record_.request_id = RequestIdOr(Metadata(context, kRequestIdHeader));
  record_.trace_id = TraceId(Metadata(context, "traceparent"));
  // Trailing metadata, because a client repeats only a call that was refused without initial metadata.
  context.AddTrailingMetadata(kRequestIdHeader, record_.request_id);
}

Call::~Call() {
  { const absl::StatusOr<Admission::Ticket> given_back = std::move(ticket_); }
  record_.duration_s = elapsed_s();
  observer_.Ended(record_);
}

double Call::elapsed_s() const {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
}

CallOptions Call::options() const {
  using std::chrono::system_clock;
  CallOptions options = {.is_stopped = [this] { return context_.IsCancelled(); }};
  const system_clock::time_point deadline = context_.deadline();
  if (deadline != system_clock::time_point::max()) {
    options.deadline = std::chrono::steady_clock::now() + (deadline - system_clock::now());
  }
  return options;
}

grpc::Status Call::Finish(const absl::Status& status) {
  record_.status = SeenByCaller(status.code(), context_);
  record_.reason = NameOf(ReasonOf(status));
  record_.message = std::string(status.message());
  return ToGrpcStatus(status);
}

}  // namespace ricochet::server
