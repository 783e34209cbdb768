// The picture of what several contacts at once can do.

#ifndef RICOCHET_CLIENT_CLI_REPORT_MULTICONTACT_PLOT_H_
#define RICOCHET_CLIENT_CLI_REPORT_MULTICONTACT_PLOT_H_

#include "client/cli/plot/plot.h"
#include "ricochet/multi_contact.h"

namespace ricochet::cli {

// The strike of planar bodies, the outcomes of the first state as points on the bars of what is possible, and the
// outcomes of springs over the stiffness, if a range of it was asked for.
Plot MultiContactPlot(const MultiContactRequest& request, const MultiContactResponse& response);

}  // namespace ricochet::cli

#endif  // RICOCHET_CLIENT_CLI_REPORT_MULTICONTACT_PLOT_H_
