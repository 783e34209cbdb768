#include "server/telemetry/call_interceptor.h"

#include <grpcpp/server_context.h>
#include <grpcpp/support/server_interceptor.h>

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "absl/strings/match.h"
#include "absl/strings/string_view.h"
#include "proto/wire/status.h"
#include "ricochet/error.h"
#include "server/base/refusals.h"
#include "server/base/request_id.h"
#include "server/base/telemetry_names.h"
#include "server/telemetry/call_record.h"

namespace ricochet::server {
namespace {

using grpc::experimental::InterceptionHookPoints;
using grpc::experimental::InterceptorBatchMethods;
using grpc::experimental::ServerRpcInfo;

// The name that gRPC gives to every method that no service has.
constexpr char kUnknownMethod[] = "unknown";

// Refusal says why a call ended before a handler ran, and holds the status to end it with.
struct Refusal {
  std::string reason;
  absl::Status status;
};

Refusal RefusalOf(const absl::Status& status) {
  // Bytes that are no message are the only invalid request of which no field can be named.
  if (absl::IsInvalidArgument(status) && ViolationsOf(status).empty()) return {kMalformedReason, status};
  const std::string reason = ReasonName(ReasonOf(status));
  if (!reason.empty()) return {reason, status};
  if (absl::IsResourceExhausted(status)) return {kThreadsReason, NoThread()};
  if (absl::IsUnimplemented(status)) return {kUnknownMethodReason, status};
  return {kRefusedByGrpcReason, status};
}

class CallInterceptor final : public grpc::experimental::Interceptor {
 public:
  CallInterceptor(std::string method, const grpc::ServerContextBase& context, const Observer& observer)
      : method_(std::move(method)), context_(context), observer_(observer) {}

  void Intercept(InterceptorBatchMethods* batch) override {
    if (batch->QueryInterceptionHookPoint(InterceptionHookPoints::PRE_SEND_STATUS) && !IsHandled(*batch)) {
      Refuse(*batch);
    }
    batch->Proceed();
  }

 private:
  // Every handler adds the request id.
  static bool IsHandled(InterceptorBatchMethods& batch) {
    return batch.GetSendTrailingMetadata()->count(kRequestIdHeader) > 0;
  }

  void Refuse(InterceptorBatchMethods& batch) const {
    const absl::Status answered = FromGrpcStatus(batch.GetSendStatus());
    if (answered.ok()) return;
    const Refusal refusal = RefusalOf(answered);
    CallRecord record = RecordOf(method_, context_);
    record.status = refusal.status.code();
    record.reason = refusal.reason;
    record.message = std::string(refusal.status.message());
    batch.GetSendTrailingMetadata()->emplace(kRequestIdHeader, record.request_id);
    if (refusal.status != answered) batch.ModifySendStatus(ToGrpcStatus(refusal.status));
    observer_.Ended(record);
  }

  const std::string method_;
  const grpc::ServerContextBase& context_;
  const Observer& observer_;
};

class Factory final : public grpc::experimental::ServerInterceptorFactoryInterface {
 public:
  explicit Factory(const Observer& observer) : observer_(observer), prefix_(PathOf("")) {}

  // Health checks and other services of gRPC are not watched.
  grpc::experimental::Interceptor* CreateServerInterceptor(ServerRpcInfo* info) override {
    absl::string_view method = info->method();
    if (method != kUnknownMethod && !absl::StartsWith(method, prefix_)) return nullptr;
    if (method != kUnknownMethod) method.remove_prefix(prefix_.size());
    observer_.Started(std::string(method));
    return new CallInterceptor(std::string(method), *info->server_context(), observer_);
  }

 private:
  const Observer& observer_;
  const std::string prefix_;
};

}  // namespace

void WatchCalls(const Observer& observer, grpc::ServerBuilder& builder) {
  std::vector<std::unique_ptr<grpc::experimental::ServerInterceptorFactoryInterface>> factories;
  factories.push_back(std::make_unique<Factory>(observer));
  builder.experimental().SetInterceptorCreators(std::move(factories));
}

}  // namespace ricochet::server
