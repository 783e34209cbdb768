// The picture of bounds: the range of each coefficient as a bar.

#ifndef RICOCHET_CLIENT_CLI_REPORT_BOUNDS_PLOT_H_
#define RICOCHET_CLIENT_CLI_REPORT_BOUNDS_PLOT_H_

#include "client/cli/plot/plot.h"
#include "ricochet/solver.h"

namespace ricochet::cli {

// Returns a panel with the four coefficients and one with the normal impulse. Each has a bar for every range that the
// answer gives: sharp, energy only, first order, and guaranteed and found over uncertain fields. A bar ends in a
// triangle at the frame where its range is infinite.
Plot BoundsPlot(const BoundsResponse& response);

}  // namespace ricochet::cli

#endif  // RICOCHET_CLIENT_CLI_REPORT_BOUNDS_PLOT_H_
