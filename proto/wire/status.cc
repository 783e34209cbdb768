#include "proto/wire/status.h"

#include <google/protobuf/any.pb.h>

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "absl/strings/cord.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/string_view.h"
#include "google/rpc/error_details.pb.h"
#include "google/rpc/status.pb.h"
#include "proto/wire/enums.h"
#include "ricochet/error.h"
#include "ricochet/v1/error_reason.pb.h"

namespace ricochet {

template <>
struct EnumPair<ErrorReason> : SameNumbers<v1::ErrorReason, v1::ErrorReason_IsValid> {};

namespace {

constexpr char kDomain[] = "ricochet";
constexpr char kReasonPrefix[] = "ERROR_REASON_";

// In base64 the details take 5.4 KiB. Together with the message this leaves half a KiB to the other trailers.
constexpr size_t kDetailsLimit = 4096;
constexpr size_t kMessageLimit = 2048;

// A violation of this length fits even if every byte of it is percent-encoded in the message.
constexpr size_t kFieldLimit = 200;
constexpr size_t kDescriptionLimit = 400;

// A violation takes at least two tags and two lengths, so no more than this number can fit.
constexpr size_t kMostViolations = kDetailsLimit / 4;

// The parts of an absl::Status that are sent.
struct Error {
  grpc::StatusCode code = grpc::StatusCode::UNKNOWN;
  std::string message;
  ErrorReason reason = ErrorReason::kUnspecified;
  std::vector<Violation> violations;
  std::optional<std::chrono::milliseconds> retry_delay;
};

google::rpc::ErrorInfo ErrorInfoOf(ErrorReason reason) {
  google::rpc::ErrorInfo info;
  info.set_reason(v1::ErrorReason_Name(ToProto(reason)).substr(sizeof(kReasonPrefix) - 1));
  info.set_domain(kDomain);
  return info;
}

ErrorReason ReasonOf(const google::rpc::ErrorInfo& info) {
  v1::ErrorReason reason = v1::ERROR_REASON_UNSPECIFIED;
  if (info.domain() != kDomain) return ErrorReason::kUnspecified;
  if (!v1::ErrorReason_Parse(absl::StrCat(kReasonPrefix, info.reason()), &reason)) {
    return ErrorReason::kUnspecified;
  }
  return FromProto<ErrorReason>(reason);
}

google::rpc::BadRequest ToProto(const std::vector<Violation>& violations) {
  google::rpc::BadRequest proto;
  for (const Violation& violation : violations) {
    google::rpc::BadRequest::FieldViolation& entry = *proto.add_field_violations();
    entry.set_field(violation.field);
    entry.set_description(violation.description);
  }
  return proto;
}

std::vector<Violation> FromProto(const google::rpc::BadRequest& proto) {
  std::vector<Violation> violations;
  for (const google::rpc::BadRequest::FieldViolation& entry : proto.field_violations()) {
    violations.push_back({entry.field(), entry.description()});
  }
  return violations;
}

google::rpc::RetryInfo ToProto(std::chrono::milliseconds delay) {
  google::rpc::RetryInfo proto;
  proto.mutable_retry_delay()->set_seconds(delay.count() / 1000);
  proto.mutable_retry_delay()->set_nanos(static_cast<int32_t>(delay.count() % 1000 * 1'000'000));
  return proto;
}

// Rounds up, because a retry before the delay has passed fails. The largest google.protobuf.Duration is 10,000 years.
std::chrono::milliseconds FromProto(const google::rpc::RetryInfo& proto) {
  const int64_t seconds = std::clamp<int64_t>(proto.retry_delay().seconds(), 0, 315'576'000'000);
  const int64_t nanos = std::clamp<int64_t>(proto.retry_delay().nanos(), 0, 999'999'999);
  return std::chrono::milliseconds(seconds * 1000 + (nanos + 999'999) / 1'000'000);
}

// Returns a google.rpc.Status, or nothing if the status has only a code and a message.
std::string SerializedDetails(const Error& error) {
  google::rpc::Status proto;
  if (error.reason != ErrorReason::kUnspecified) {
    proto.add_details()->PackFrom(ErrorInfoOf(error.reason));
  }
  if (!error.violations.empty()) proto.add_details()->PackFrom(ToProto(error.violations));
  if (error.retry_delay.has_value()) proto.add_details()->PackFrom(ToProto(*error.retry_delay));
  if (proto.details().empty()) return "";
  proto.set_code(error.code);
  proto.set_message(error.message);
  return proto.SerializeAsString();
}

// Returns the size of the trailer grpc-message for `text`, in bytes.
size_t PercentEncodedSize(const std::string& text) {
  size_t size = 0;
  for (const char c : text) size += c >= ' ' && c <= '~' && c != '%' ? 1 : 3;
  return size;
}

bool Fits(const Error& error) {
  return PercentEncodedSize(error.message) <= kMessageLimit && SerializedDetails(error).size() <= kDetailsLimit;
}

// Returns the first `size` bytes or fewer, so that no UTF-8 sequence is cut, which would make a proto unreadable.
std::string Prefix(const std::string& text, size_t size) {
  while (size > 0 && (static_cast<unsigned char>(text[size]) & 0xC0) == 0x80) --size;
  return text.substr(0, size);
}

// Returns `text` if it has at most `limit` bytes; else its beginning and the number of bytes that were cut.
std::string Clipped(const std::string& text, size_t limit) {
  constexpr size_t kNoteSize = sizeof("... (18446744073709551615 more bytes)");
  if (text.size() <= limit) return text;
  const std::string kept = Prefix(text, limit - kNoteSize);
  return absl::StrCat(kept, "... (", text.size() - kept.size(), " more bytes)");
}

// Says that violations were left out, after the last one that was kept.
constexpr char kMoreViolations[] = " (and more violations)";

// Returns the status with the first `count` violations only, which the message lists.
Error WithViolations(const Error& error, size_t count) {
  Error cut = error;
  cut.violations.resize(count);
  for (Violation& violation : cut.violations) {
    violation = {Clipped(violation.field, kFieldLimit), Clipped(violation.description, kDescriptionLimit)};
  }
  if (count < error.violations.size()) {
    cut.violations.back().description += kMoreViolations;
  }
  cut.message = std::string(InvalidRequest(cut.violations).message());
  return cut;
}

// Returns the status with as many violations as fit.
Error WithFewerViolations(const Error& error) {
  size_t fitting = 1;
  size_t too_many = std::min(error.violations.size(), kMostViolations) + 1;
  while (too_many - fitting > 1) {
    const size_t middle = fitting + (too_many - fitting) / 2;
    (Fits(WithViolations(error, middle)) ? fitting : too_many) = middle;
  }
  return WithViolations(error, fitting);
}

Error Fitted(const Error& error) {
  if (Fits(error)) return error;
  if (!error.violations.empty()) return WithFewerViolations(error);
  // A plain message keeps the full length; a message of percent-encoded bytes keeps a third of it.
  Error cut = error;
  cut.message = Clipped(error.message, kMessageLimit);
  if (!Fits(cut)) cut.message = Clipped(error.message, kMessageLimit / 3);
  return cut;
}

}  // namespace

void CopyPayloads(const absl::Status& from, absl::Status& to) {
  from.ForEachPayload([&](absl::string_view url, const absl::Cord& payload) { to.SetPayload(url, payload); });
}

grpc::Status ToGrpcStatus(const absl::Status& status) {
  if (status.ok()) return grpc::Status::OK;
  const Error error = Fitted({.code = static_cast<grpc::StatusCode>(status.code()),
                              .message = std::string(status.message()),
                              .reason = ReasonOf(status),
                              .violations = ViolationsOf(status),
                              .retry_delay = RetryDelayOf(status)});
  return {error.code, error.message, SerializedDetails(error)};
}

absl::Status FromGrpcStatus(const grpc::Status& status) {
  if (status.ok()) return absl::OkStatus();
  const auto code = static_cast<absl::StatusCode>(status.error_code());
  absl::Status result(code, status.error_message());
  google::rpc::Status proto;
  if (!proto.ParseFromString(status.error_details())) return result;
  ErrorReason reason = ErrorReason::kUnspecified;
  for (const google::protobuf::Any& detail : proto.details()) {
    google::rpc::ErrorInfo info;
    google::rpc::BadRequest bad_request;
    google::rpc::RetryInfo retry;
    if (detail.UnpackTo(&info)) reason = ReasonOf(info);
    if (detail.UnpackTo(&bad_request) && bad_request.field_violations_size() > 0) {
      CopyPayloads(InvalidRequest(FromProto(bad_request)), result);
    }
    if (detail.UnpackTo(&retry)) SetRetryDelay(FromProto(retry), result);
  }
  if (reason != ErrorReason::kUnspecified) CopyPayloads(MakeError(code, reason, ""), result);
  return result;
}

}  // namespace ricochet
