// The end of a run: exit codes, and the errors that a user sees.

#ifndef RICOCHET_CLIENT_CLI_TERMINAL_EXIT_CODE_H_
#define RICOCHET_CLIENT_CLI_TERMINAL_EXIT_CODE_H_

#include "absl/status/status.h"
#include "client/cli/terminal/interrupt.h"

namespace ricochet::cli {

enum ExitCode : int {
  kOk = 0,
  kUsage = 2,                           // A flag, scene or request is wrong: the same call will fail again.
  kFailed = 42,                         // Any other failure that a retry does not cure.
  kTryAgain = 75,                       // EX_TEMPFAIL: the server is unreachable, busy or too slow.
  kInterrupted = kInterruptedExitCode,  // Ctrl-C or SIGTERM ended the run.
};

ExitCode ExitCodeOf(const absl::Status& status);

// Prints the error on stderr: one line "field = value: must ..." for each violation, or the message. It prints nothing
// for OK, nor if the reader of standard output has gone.
void PrintError(const absl::Status& status);

}  // namespace ricochet::cli

#endif  // RICOCHET_CLIENT_CLI_TERMINAL_EXIT_CODE_H_
