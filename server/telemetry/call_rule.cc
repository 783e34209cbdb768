#include "server/telemetry/call_rule.h"

#include <charconv>
#include <cmath>
#include <system_error>
#include <utility>

#include "absl/strings/match.h"
#include "absl/strings/string_view.h"

namespace ricochet::server {
namespace {

constexpr int64_t kMostCount = int64_t{1} << 53;
constexpr double kMostSeconds = 3600.0;

template <typename Number>
std::optional<Number> NumberAfter(const std::string& text, absl::string_view prefix, Number least, Number most) {
  if (!absl::StartsWith(text, prefix)) return std::nullopt;
  Number number = {};
  const char* const end = text.data() + text.size();
  const auto read = std::from_chars(text.data() + prefix.size(), end, number);
  if (read.ec != std::errc() || read.ptr != end || !(number >= least && number <= most)) return std::nullopt;
  return number;
}

}  // namespace

std::optional<CallRule> ParseCallRule(const std::string& text) {
  if (text == "all") return CallRule{.kind = CallRule::Kind::kAll};
  if (text == "errors") return CallRule{.kind = CallRule::Kind::kErrors};
  if (const auto seconds = NumberAfter<double>(text, "slow:", 0.0, kMostSeconds)) {
    return CallRule{.kind = CallRule::Kind::kSlow, .slow = std::chrono::milliseconds(std::llround(*seconds * 1e3))};
  }
  if (const auto count = NumberAfter<int64_t>(text, "sample:", 1, kMostCount)) {
    return CallRule{.kind = CallRule::Kind::kSample, .count = *count};
  }
  if (const auto count = NumberAfter<int64_t>(text, "rate:", 1, kMostCount)) {
    return CallRule{.kind = CallRule::Kind::kRate, .count = *count};
  }
  return std::nullopt;
}

bool CallSampler::Takes(const CallRecord& call, Clock::time_point now) {
  if (call.status != absl::StatusCode::kOk) return true;
  switch (rule_.kind) {
    case CallRule::Kind::kAll:
      return true;
    case CallRule::Kind::kErrors:
      return false;
    case CallRule::Kind::kSlow:
      return call.duration_s * 1e3 >= static_cast<double>(rule_.slow.count());
    case CallRule::Kind::kSample:
      return seen_++ % rule_.count == 0;
    case CallRule::Kind::kRate:
      break;
  }
  if (now - second_ >= std::chrono::seconds(1)) {
    second_ = now;
    seen_ = 0;
  }
  return seen_++ < rule_.count;
}

std::optional<int64_t> CallSampler::Take(const CallRecord& call, Clock::time_point now) {
  const std::lock_guard lock(mutex_);
  if (Takes(call, now)) return std::exchange(left_out_, 0);
  ++left_out_;
  return std::nullopt;
}

}  // namespace ricochet::server
