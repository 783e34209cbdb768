// The derivatives of an outcome as text and as CSV.

#ifndef RICOCHET_CLIENT_CLI_REPORT_DERIVATIVES_REPORT_H_
#define RICOCHET_CLIENT_CLI_REPORT_DERIVATIVES_REPORT_H_

#include <string>
#include <vector>

#include "ricochet/derivatives.h"

namespace ricochet::cli {

// A table of the derivatives, and a sentence for each that has not both sides alike.
std::string DerivativesText(const std::vector<Derivative>& derivatives);

// A header and one row for each derivative.
std::string DerivativesCsv(const std::vector<Derivative>& derivatives);

}  // namespace ricochet::cli

#endif  // RICOCHET_CLIENT_CLI_REPORT_DERIVATIVES_REPORT_H_
