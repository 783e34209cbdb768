#include "server/base/telemetry_names.h"

#include "absl/strings/ascii.h"
#include "ricochet/v1/error_reason.pb.h"
#include "ricochet/v1/plan.pb.h"

namespace ricochet::server {

bool IsTransportReason(absl::string_view reason) {
  return reason == kMalformedReason || reason == kThreadsReason || reason == kUnknownMethodReason ||
         reason == kRefusedByGrpcReason;
}

std::string ReasonName(ErrorReason reason) {
  constexpr size_t kPrefix = sizeof("ERROR_REASON_") - 1;
  if (reason == ErrorReason::kUnspecified) return "";
  return v1::ErrorReason_Name(static_cast<v1::ErrorReason>(reason)).substr(kPrefix);
}

std::string ModelName(size_t model) {
  constexpr size_t kPrefix = sizeof("MODEL_") - 1;
  return absl::AsciiStrToLower(v1::Model_Name(static_cast<v1::Model>(model)).substr(kPrefix));
}

}  // namespace ricochet::server
