// RunGnuplot: draws by gnuplot as a child process.

#ifndef RICOCHET_CLIENT_CLI_PLOT_GNUPLOT_H_
#define RICOCHET_CLIENT_CLI_PLOT_GNUPLOT_H_

#include <string>

#include "absl/status/statusor.h"

namespace ricochet::cli {

// Runs the commands of `script` and returns what it draws to its standard output, so that no file of gnuplot's is left
// if the disk is full. What gnuplot says goes to standard error. Errors: FAILED_PRECONDITION if gnuplot is not
// installed, INTERNAL if it fails; those of the system.
absl::StatusOr<std::string> RunGnuplot(const std::string& script);

}  // namespace ricochet::cli

#endif  // RICOCHET_CLIENT_CLI_PLOT_GNUPLOT_H_
