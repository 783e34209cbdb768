// Pictures of a cost study, in the conventions of work-precision diagrams: logarithmic axes, one line for each method,
// whose points are the tolerances or digits that it was asked for.

#ifndef RICOCHET_CLIENT_CLI_COST_PICTURE_H_
#define RICOCHET_CLIENT_CLI_COST_PICTURE_H_

#include <string>

#include "client/cli/plot.h"
#include "ricochet/cost.h"

namespace ricochet::cli {

enum class PictureWidth { kWide, kNarrow };

// Each function takes a whole study: all rows in one CostChunk, with its summary.

// Returns the time of one solve over the error made.
Plot CostTimePlot(const CostChunk& study, PictureWidth width);

// Returns the error made over the error claimed.
Plot CostClaimPlot(const CostChunk& study, PictureWidth width);

// Returns both, side by side with one legend; `title` stands above them.
Plot CostPlot(const CostChunk& study, const std::string& title);

}  // namespace ricochet::cli

#endif  // RICOCHET_CLIENT_CLI_COST_PICTURE_H_
