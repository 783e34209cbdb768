// Writes what several contacts at once can do as text, CSV and a picture.

#ifndef RICOCHET_CLIENT_CLI_REPORT_MULTICONTACT_REPORT_H_
#define RICOCHET_CLIENT_CLI_REPORT_MULTICONTACT_REPORT_H_

#include <string>
#include <vector>

#include "client/cli/plot/plot.h"
#include "ricochet/multi_contact.h"

namespace ricochet::cli {

// Returns the verdict first, then the outcomes, what each contact did, the bounds, and what was left out.
std::string MultiContactText(const MultiContactRequest& request, const MultiContactResponse& response);

// Returns one row for each outcome and sample, and for each end of the bounds.
std::string MultiContactCsv(const MultiContactRequest& request, const MultiContactResponse& response);

// Returns the names of the numbers of an outcome, with which the answer's bounds begin: its contact velocities, and the
// velocities of the system if they are others.
std::vector<std::string> OutputNames(const MultiContactRequest& request);

// Returns the numbers that have these names.
std::vector<double> NumbersOf(const AttainedOutcome& outcome);

// Draws the strike of planar bodies, the outcomes of the first state as points on the bars of what is possible, and the
// outcomes of springs over the stiffness, if a range of it was asked for.
Plot MultiContactPlot(const MultiContactRequest& request, const MultiContactResponse& response);

}  // namespace ricochet::cli

#endif  // RICOCHET_CLIENT_CLI_REPORT_MULTICONTACT_REPORT_H_
