// CallRule: which calls get a line in the log. A call that failed always gets one.
//
// A line takes some 300 bytes. At 30,000 calls a second that is 9 MB a second, so the default bounds their rate.

#ifndef RICOCHET_SERVER_TELEMETRY_CALL_RULE_H_
#define RICOCHET_SERVER_TELEMETRY_CALL_RULE_H_

#include <chrono>
#include <cstdint>
#include <mutex>
#include <optional>
#include <string>

#include "server/telemetry/call_record.h"

namespace ricochet::server {

struct CallRule {
  enum class Kind {
    kAll,
    kErrors,  // Only calls that failed.
    kSlow,    // Also calls that took `slow` or longer.
    kSample,  // Also the first of each `count` calls.
    kRate,    // Also the first `count` calls in each second.
  };
  Kind kind = Kind::kRate;
  int64_t count = 100;                // 1 to 2^53.
  std::chrono::milliseconds slow{0};  // 0 to 1 h.

  friend bool operator==(const CallRule&, const CallRule&) = default;
};

inline constexpr char kCallRuleForm[] =
    "must be all, errors, slow:SECONDS with 0 to 3600, or sample:N or rate:N with an integer from 1 to 2^53";

// Reads "all", "errors", "slow:0.5", "sample:1000" or "rate:100". Returns nothing for any other text.
std::optional<CallRule> ParseCallRule(const std::string& text);

// CallSampler applies a rule. Thread safety: every method may be called from several threads at once.
class CallSampler {
 public:
  using Clock = std::chrono::steady_clock;

  explicit CallSampler(const CallRule& rule) : rule_(rule) {}

  // Returns how many calls were left out since the last call that was not, if a call that ends at `now` gets a line.
  // Returns nothing if the call is left out.
  std::optional<int64_t> Take(const CallRecord& call, Clock::time_point now);

 private:
  bool Takes(const CallRecord& call, Clock::time_point now);

  const CallRule rule_;
  std::mutex mutex_;
  Clock::time_point second_;  // When the current second of kRate has begun.
  int64_t seen_ = 0;          // Calls since then; for kSample, all calls.
  int64_t left_out_ = 0;
};

}  // namespace ricochet::server

#endif  // RICOCHET_SERVER_TELEMETRY_CALL_RULE_H_
