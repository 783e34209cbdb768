// The report of a fit as text, CSV and a picture.

#ifndef RICOCHET_CLIENT_CLI_REPORT_FIT_REPORT_H_
#define RICOCHET_CLIENT_CLI_REPORT_FIT_REPORT_H_

#include <string>

#include "client/cli/plot/plot.h"
#include "ricochet/fit.h"

namespace ricochet::cli {

// Returns the unknowns with their intervals, correlations, residuals of the first rows, and notes.
std::string FitText(const FitRequest& request, const FitResponse& response);

// Returns what the rows of CSV do not say: how well the model fits, whether the data refuse it, and the notes.
std::string FitSummaryText(const FitResponse& response);

// Returns a row for each unknown.
std::string FitCsv(const FitResponse& response);

// Returns a row for each row of the data: its regime, and the prediction and residual of each measured column.
std::string FitRowsCsv(const FitRequest& request, const FitResponse& response);

// Draws a panel for each measured column, one for all residuals, one for each unknown, and one for the region if it was
// asked for. Data stand over the first input that differs by row, else over the number of the row.
Plot FitPlot(const FitRequest& request, const FitResponse& response);

}  // namespace ricochet::cli

#endif  // RICOCHET_CLIENT_CLI_REPORT_FIT_REPORT_H_
