#include "client/cli/terminal/exit_code.h"

#include <cstdio>
#include <string>
#include <vector>

#include "client/cli/io/output.h"
#include "client/cli/terminal/progress.h"
#include "core/base/utf8.h"
#include "ricochet/error.h"

namespace ricochet::cli {
namespace {

// The request itself is too large, so that the same one will be refused again.
bool IsTooLarge(const absl::Status& status) {
  const ErrorReason reason = ReasonOf(status);
  return reason == ErrorReason::kSweepTooLarge || reason == ErrorReason::kLimitExceeded;
}

}  // namespace

ExitCode ExitCodeOf(const absl::Status& status) {
  if (status.ok() || IsReaderGone(status)) return kOk;
  switch (status.code()) {
    case absl::StatusCode::kInvalidArgument:
      return kUsage;
    case absl::StatusCode::kResourceExhausted:
      return IsTooLarge(status) ? kFailed : kTryAgain;
    case absl::StatusCode::kCancelled:
      return Interrupt::Happened() ? kInterrupted : kTryAgain;
    case absl::StatusCode::kUnavailable:
    case absl::StatusCode::kDeadlineExceeded:
    case absl::StatusCode::kAborted:
      return kTryAgain;
    default:
      return kFailed;
  }
}

void PrintError(const absl::Status& status) {
  if (status.ok() || IsReaderGone(status)) return;
  Progress::Erase();
  if (ExitCodeOf(status) == kInterrupted) {
    std::fputs("ricochet: interrupted\n", stderr);
    return;
  }
  const std::vector<Violation> violations = ViolationsOf(status);
  for (const Violation& violation : violations) {
    std::fprintf(stderr, "%s %s\n", Printable(violation.field).c_str(), Printable(violation.description).c_str());
  }
  if (violations.empty()) {
    std::fprintf(stderr, "ricochet: %s: %s\n", absl::StatusCodeToString(status.code()).c_str(),
                 Printable(std::string(status.message())).c_str());
  }
}

}  // namespace ricochet::cli
