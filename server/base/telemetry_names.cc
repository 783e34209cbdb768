#include "server/base/telemetry_names.h"

#include "absl/strings/ascii.h"
#include "ricochet/v1/error_reason.pb.h"
#include "ricochet/v1/plan.pb.h"

namespace ricochet::server {

const std::vector<std::string>& Reasons() {
  static const auto* const all = [] {
    auto* const reasons =
        new std::vector<std::string>{kMalformedReason,     kThreadsReason,         kUnknownMethodReason,
                                     kRefusedByGrpcReason, kUnauthenticatedReason, kPermissionDeniedReason};
    for (int i = v1::ERROR_REASON_UNSPECIFIED + 1; i < v1::ErrorReason_ARRAYSIZE; ++i) {
      reasons->push_back(ReasonName(static_cast<ErrorReason>(i)));
    }
    return reasons;
  }();
  return *all;
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
