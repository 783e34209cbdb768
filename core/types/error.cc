#include "ricochet/error.h"

#include <cassert>
#include <limits>
#include <utility>

#include "absl/strings/cord.h"
#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "absl/strings/str_split.h"
#include "core/base/decimal.h"

namespace ricochet {
namespace {

constexpr char kReasonUrl[] = "ricochet/reason";
constexpr char kViolationsUrl[] = "ricochet/violations";
constexpr char kRetryDelayUrl[] = "ricochet/retry_delay_ms";

// These control characters separate the entries of the list, because no field path or description contains them.
constexpr char kFieldEnd = '\x1f';
constexpr char kEntryEnd = '\x1e';

std::optional<std::string> Payload(const absl::Status& status, const char* url) {
  const auto payload = status.GetPayload(url);
  if (!payload.has_value()) return std::nullopt;
  return std::string(*payload);
}

// Returns as many violations as a status lists; the last one says if there are more.
std::vector<Violation> Listed(const std::vector<Violation>& violations) {
  if (!IsFull(violations)) return violations;
  std::vector<Violation> listed(violations.begin(), violations.begin() + kMostViolations);
  listed.back().description += " (and more violations)";
  return listed;
}

absl::Status Listing(absl::StatusCode code, ErrorReason reason, const std::vector<Violation>& all) {
  assert(!all.empty());
  const std::vector<Violation> violations = Listed(all);
  const std::string message = absl::StrJoin(violations, "; ", [](std::string* out, const Violation& violation) {
    absl::StrAppend(out, violation.field, " ", violation.description);
  });
  std::string data;
  for (const Violation& violation : violations) {
    absl::StrAppend(&data, violation.field, std::string(1, kFieldEnd), violation.description,
                    std::string(1, kEntryEnd));
  }
  absl::Status status = MakeError(code, reason, message);
  status.SetPayload(kViolationsUrl, absl::Cord(data));
  return status;
}

}  // namespace

Violation MakeViolation(std::string field, const std::string& found, std::string rule, ViolationKind kind,
                        std::vector<std::string> tied_to) {
  std::string description = absl::StrCat(found, ": must ", rule);
  return {std::move(field), std::move(description), kind, std::move(tied_to), std::move(rule)};
}

Violation MakeViolation(std::string field, double value, std::string rule, std::vector<std::string> tied_to) {
  return MakeViolation(std::move(field), absl::StrCat("= ", ShortestDecimal(value)), std::move(rule),
                       ViolationKind::kValue, std::move(tied_to));
}

absl::Status MakeError(absl::StatusCode code, ErrorReason reason, const std::string& message) {
  assert(code != absl::StatusCode::kOk);
  absl::Status status(code, message);
  status.SetPayload(kReasonUrl, absl::Cord(absl::StrCat(static_cast<int>(reason))));
  return status;
}

absl::Status InvalidRequest(const std::vector<Violation>& violations) {
  return Listing(absl::StatusCode::kInvalidArgument, ErrorReason::kInvalidRequest, violations);
}

absl::Status LimitExceeded(const std::vector<Violation>& violations) {
  return Listing(absl::StatusCode::kResourceExhausted, ErrorReason::kLimitExceeded, violations);
}

absl::Status WithViolations(const absl::Status& from, const std::vector<Violation>& violations) {
  return Listing(from.code(), ReasonOf(from), violations);
}

absl::Status OutputOverflow(const std::string& path) {
  return MakeError(absl::StatusCode::kOutOfRange, ErrorReason::kOutputOverflow,
                   absl::StrCat(path, ": the exact value exceeds the largest double, ",
                                ShortestDecimal(std::numeric_limits<double>::max())));
}

ErrorReason ReasonOf(const absl::Status& status) {
  int reason = 0;
  const auto text = Payload(status, kReasonUrl);
  if (!text.has_value() || !absl::SimpleAtoi(*text, &reason)) return ErrorReason::kUnspecified;
  return static_cast<ErrorReason>(reason);
}

std::vector<Violation> ViolationsOf(const absl::Status& status) {
  std::vector<Violation> violations;
  const auto data = Payload(status, kViolationsUrl);
  if (!data.has_value()) return violations;
  for (absl::string_view entry : absl::StrSplit(*data, kEntryEnd, absl::SkipEmpty())) {
    const std::pair<std::string, std::string> parts = absl::StrSplit(entry, absl::MaxSplits(kFieldEnd, 1));
    violations.push_back({parts.first, parts.second});
  }
  return violations;
}

void SetRetryDelay(std::chrono::milliseconds delay, absl::Status& status) {
  status.SetPayload(kRetryDelayUrl, absl::Cord(absl::StrCat(delay.count())));
}

std::optional<std::chrono::milliseconds> RetryDelayOf(const absl::Status& status) {
  int64_t milliseconds = 0;
  const auto text = Payload(status, kRetryDelayUrl);
  if (!text.has_value() || !absl::SimpleAtoi(*text, &milliseconds)) return std::nullopt;
  return std::chrono::milliseconds(milliseconds);
}

}  // namespace ricochet
