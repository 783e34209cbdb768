// The picture of a fit: data over model, residuals, profiles, and the region of two unknowns.

#ifndef RICOCHET_CLIENT_CLI_REPORT_FIT_PLOT_H_
#define RICOCHET_CLIENT_CLI_REPORT_FIT_PLOT_H_

#include "client/cli/plot/plot.h"
#include "ricochet/fit.h"

namespace ricochet::cli {

// One panel for each measured column, one for all residuals, one for each unknown, and one for the region if it was
// asked for. Data stand over the first input that differs by row, else over the number of the row.
Plot FitPlot(const FitRequest& request, const FitResponse& response);

}  // namespace ricochet::cli

#endif  // RICOCHET_CLIENT_CLI_REPORT_FIT_PLOT_H_
