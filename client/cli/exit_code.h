// How a run ends: exit codes, and errors for people.

#ifndef RICOCHET_CLIENT_CLI_EXIT_CODE_H_
#define RICOCHET_CLIENT_CLI_EXIT_CODE_H_

#include "absl/status/status.h"

namespace ricochet::cli {

enum ExitCode : int {
  kOk = 0,
  kUsage = 2,      // A wrong flag, scene or request: the same call will fail again.
  kFailed = 42,    // Every other failure that a retry will not mend.
  kTryAgain = 75,  // EX_TEMPFAIL: the server is away, busy or late.
};

ExitCode ExitCodeOf(const absl::Status& status);

// On stderr: one line a violation, "field = value: must ...", or the message.
void PrintError(const absl::Status& status);

}  // namespace ricochet::cli

#endif  // RICOCHET_CLIENT_CLI_EXIT_CODE_H_
