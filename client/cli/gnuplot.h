// RunGnuplot: draws by gnuplot as a child process.

#ifndef RICOCHET_CLIENT_CLI_GNUPLOT_H_
#define RICOCHET_CLIENT_CLI_GNUPLOT_H_

#include <string>

#include "absl/status/status.h"

namespace ricochet::cli {

// Runs the commands of `script`. What gnuplot prints goes to standard error.
// Errors: FAILED_PRECONDITION if gnuplot is not installed, INTERNAL if it fails.
absl::Status RunGnuplot(const std::string& script);

}  // namespace ricochet::cli

#endif  // RICOCHET_CLIENT_CLI_GNUPLOT_H_
