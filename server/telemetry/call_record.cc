#include "server/telemetry/call_record.h"

#include <utility>

#include "absl/strings/str_cat.h"
#include "ricochet/v1/impact_service.grpc.pb.h"
#include "server/base/request_id.h"
#include "server/base/trace_parent.h"

namespace ricochet::server {
namespace {

// Returns the first value that the caller sent under a name, or an empty text.
std::string Metadata(const grpc::ServerContextBase& context, const char* name) {
  const auto found = context.client_metadata().find(name);
  if (found == context.client_metadata().end()) return "";
  return {found->second.data(), found->second.size()};
}

}  // namespace

CallRecord RecordOf(std::string method, const grpc::ServerContextBase& context) {
  CallRecord record;
  record.method = std::move(method);
  record.peer = context.peer();
  record.user_agent = Metadata(context, "user-agent");
  record.request_id = RequestIdOr(Metadata(context, kRequestIdHeader));
  record.trace_id = TraceId(Metadata(context, "traceparent"));
  return record;
}

std::string PathOf(const std::string& method) {
  return absl::StrCat("/", v1::ImpactService::service_full_name(), "/", method);
}

}  // namespace ricochet::server
