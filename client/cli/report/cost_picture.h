// Pictures of a cost study, in the conventions of work-precision diagrams: logarithmic axes, one line for each method,
// whose points are the tolerances or digits that it was asked for.

#ifndef RICOCHET_CLIENT_CLI_REPORT_COST_PICTURE_H_
#define RICOCHET_CLIENT_CLI_REPORT_COST_PICTURE_H_

#include <string>

#include "client/cli/plot/plot.h"
#include "ricochet/cost.h"

namespace ricochet::cli {

enum class PictureWidth { kWide, kNarrow };

// Each function takes a whole study: all rows in one CostChunk, with its summary.

// Returns the time of one solve over the error made.
Plot CostTimePlot(const CostChunk& study, PictureWidth width);

// Returns the error made over the error claimed.
Plot CostClaimPlot(const CostChunk& study, PictureWidth width);

// Returns both, side by side with one legend, beside them or below where there is no room; `title` stands above them.
// The size is in pixels, or 0 and 0 for one that suits.
Plot CostPlot(const CostChunk& study, const std::string& title, int width = 0, int height = 0);

}  // namespace ricochet::cli

#endif  // RICOCHET_CLIENT_CLI_REPORT_COST_PICTURE_H_
