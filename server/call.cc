#include "server/call.h"

#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "proto/wire/status.h"
#include "ricochet/v1/impact_service.grpc.pb.h"

namespace ricochet::server {

Call::Call(const char* method, const grpc::ServerContext& context, Admission& admission, const Log& log)
    : context_(context),
      log_(log),
      method_(absl::StrCat("/", v1::ImpactService::service_full_name(), "/", method)),
      peer_(context.peer()),
      ticket_(admission.Enter()) {}

Call::~Call() {
  std::vector<LogField> fields = {{"peer", peer_},
                                  {"method", method_},
                                  {"status", absl::StatusCodeToString(code_)},
                                  {"duration_ms", elapsed_s() * 1e3}};
  if (points_.has_value()) fields.push_back({"points", *points_});
  log_.Write(LogLevel::kInfo, "call", fields);
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
  code_ = status.code();
  return ToGrpcStatus(status);
}

}  // namespace ricochet::server
