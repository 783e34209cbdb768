// The answer of Solve as text, CSV and picture.

#ifndef RICOCHET_CLIENT_CLI_SOLVE_REPORT_H_
#define RICOCHET_CLIENT_CLI_SOLVE_REPORT_H_

#include <string>

#include "absl/status/statusor.h"
#include "client/cli/plot.h"
#include "ricochet/outcome.h"

namespace ricochet::cli {

// Tables with units, to six digits.
std::string SolveText(const Outcome& outcome);

// A header and one row: every number of the outcome but its lists of events, states and broken limits and its
// certificate, by path.
std::string SolveCsv(const Outcome& outcome);

// A header and one row for each state of the history.
std::string HistoryCsv(const Outcome& outcome);

// A header and one row for each sample of the forces.
std::string ForceHistoryCsv(const Outcome& outcome);

// Fig. 3 and Fig. 5 of the paper: w(tau), F/N(tau) and f(tau) side by side.
// Errors: FAILED_PRECONDITION where nothing happens, so that there is nothing to draw.
absl::StatusOr<Plot> SolvePlot(const Outcome& outcome);

}  // namespace ricochet::cli

#endif  // RICOCHET_CLIENT_CLI_SOLVE_REPORT_H_
