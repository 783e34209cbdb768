// The derivatives of an outcome as text and as CSV.

#ifndef RICOCHET_CLIENT_CLI_REPORT_DERIVATIVES_REPORT_H_
#define RICOCHET_CLIENT_CLI_REPORT_DERIVATIVES_REPORT_H_

#include <string>
#include <vector>

#include "ricochet/derivatives.h"

namespace ricochet::cli {

// Returns a table of the derivatives, and a sentence for each whose two sides are not alike.
std::string DerivativesText(const std::vector<Derivative>& derivatives);

// Returns a header and one row for each derivative.
std::string DerivativesCsv(const std::vector<Derivative>& derivatives);

}  // namespace ricochet::cli

#endif  // RICOCHET_CLIENT_CLI_REPORT_DERIVATIVES_REPORT_H_
