#include <algorithm>
#include <cmath>
#include <vector>

#include "absl/strings/ascii.h"
#include "absl/strings/escaping.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "absl/strings/str_split.h"
#include "absl/strings/string_view.h"
#include "client/call_context.h"
#include "client/credentials.h"
#include "client/server_address.h"
#include "core/base/decimal.h"
#include "ricochet/client_options.h"
#include "ricochet/error.h"

namespace ricochet {
namespace {

constexpr int kMostAttempts = 5;  // gRPC treats a larger number as 5.
constexpr size_t kLongestUserAgent = 256;

std::string Seconds(std::chrono::milliseconds time) {
  return absl::StrFormat("%d.%03ds", time.count() / 1000, time.count() % 1000);
}

std::string Found(std::chrono::milliseconds time, const char* rule) {
  return absl::StrCat("= ", time.count(), " ms: must ", rule);
}

// Refuses a time that no clock could add.
void CheckTime(const char* name, std::chrono::milliseconds time, std::vector<Violation>& violations) {
  if (time.count() > 0 && time <= kLongestTime) return;
  violations.push_back({name, Found(time, "be > 0 and at most a year")});
}

std::string TargetRule(const std::string& target) {
  if (target.empty()) return "is empty: must be \"host:port\"";
  if (target.find_first_of(" \t\r\n") != std::string::npos) {
    return absl::StrCat("= \"", target, "\": must not contain white space");
  }
  for (const absl::string_view server : absl::StrSplit(target, ',')) {
    if (server.empty()) return absl::StrCat("= \"", target, "\": must name a server before and after each comma");
    if (const std::string wrong = WhyNoAddress(std::string(server)); !wrong.empty()) {
      return absl::StrCat("= \"", target, "\": ", wrong);
    }
  }
  return "";
}

void CheckRetry(const RetryPolicy& retry, std::vector<Violation>& violations) {
  if (retry.max_attempts < 1 || retry.max_attempts > kMostAttempts) {
    violations.push_back({"retry.max_attempts", absl::StrCat("= ", retry.max_attempts, ": must be in [1, 5]")});
  }
  if (retry.max_resumes < 0) {
    violations.push_back({"retry.max_resumes", absl::StrCat("= ", retry.max_resumes, ": must be >= 0")});
  }
  CheckTime("retry.initial_backoff", retry.initial_backoff, violations);
  if (retry.max_backoff < retry.initial_backoff) {
    violations.push_back({"retry.max_backoff", Found(retry.max_backoff, "be >= retry.initial_backoff")});
  } else {
    CheckTime("retry.max_backoff", retry.max_backoff, violations);
  }
  if (!(retry.multiplier >= 1.0) || std::isinf(retry.multiplier)) {
    violations.push_back(MakeViolation("retry.multiplier", retry.multiplier, "be finite and >= 1"));
  }
}

}  // namespace

absl::Status ValidateOptions(const ClientOptions& options) {
  std::vector<Violation> violations;
  if (const std::string wrong = TargetRule(options.target); !wrong.empty()) {
    violations.push_back({"target", wrong});
  }
  CheckTime("deadline", options.deadline, violations);
  if (options.sweep_deadline.has_value()) CheckTime("sweep_deadline", *options.sweep_deadline, violations);
  if (options.max_receive_bytes < 1 || options.max_receive_bytes > kMostReceiveBytes) {
    violations.push_back({"max_receive_bytes",
                          absl::StrCat("= ", options.max_receive_bytes, ": must be in [1, ", kMostReceiveBytes, "]")});
  }
  CheckRetry(options.retry, violations);
  const std::string& agent = options.user_agent;
  if (agent.size() > kLongestUserAgent || !std::all_of(agent.begin(), agent.end(), absl::ascii_isprint)) {
    violations.push_back(
        {"user_agent", absl::StrCat("= \"", absl::CEscape(agent.substr(0, kLongestUserAgent)), "\": must be at most ",
                                    kLongestUserAgent, " printable characters of ASCII")});
  }
  if (options.fan_out.has_value() && options.fan_out->buffer_bytes <= 0) {
    violations.push_back({"fan_out.buffer_bytes", absl::StrCat("= ", options.fan_out->buffer_bytes, ": must be > 0")});
  }
  if (options.fan_out.has_value()) CheckTime("fan_out.slow_after", options.fan_out->slow_after, violations);
  for (const std::string& target : Targets(options)) {
    const std::vector<Violation> broken = SecurityViolations(options.security, target);
    violations.insert(violations.end(), broken.begin(), broken.end());
    // Most rules do not depend on the target, and none needs to be named twice.
    if (!broken.empty()) break;
  }
  return violations.empty() ? absl::OkStatus() : InvalidRequest(violations);
}

std::vector<std::string> Targets(const ClientOptions& options) { return absl::StrSplit(options.target, ','); }

std::string ServiceConfig(const ClientOptions& options) {
  const RetryPolicy& retry = options.retry;
  // gRPC refuses a policy of one attempt; without a policy it does not retry either.
  if (retry.max_attempts == 1) return "{}";
  // A sweep is taken up again by its reader, so that gRPC has no policy for it.
  return absl::StrCat(R"({"methodConfig":[{"name":[{"service":"ricochet.v1.ImpactService","method":"Sweep"}]},)",
                      R"({"name":[{"service":"ricochet.v1.ImpactService"}],"retryPolicy":{)", R"("maxAttempts":)",
                      retry.max_attempts,                                              //
                      R"(,"initialBackoff":")", Seconds(retry.initial_backoff),        //
                      R"(","maxBackoff":")", Seconds(retry.max_backoff),               //
                      R"(","backoffMultiplier":)", ShortestDecimal(retry.multiplier),  //
                      R"(,"retryableStatusCodes":["UNAVAILABLE","CANCELLED"]}}],)",
                      R"("retryThrottling":{"maxTokens":10,"tokenRatio":0.1}})");
}

}  // namespace ricochet
