// The report of a plan as text and as CSV.

#ifndef RICOCHET_CLIENT_CLI_REPORT_PLAN_REPORT_H_
#define RICOCHET_CLIENT_CLI_REPORT_PLAN_REPORT_H_

#include <string>
#include <vector>

#include "ricochet/plan.h"

namespace ricochet::cli {

// Returns the model, the sum of all that is left out, the arithmetic, and one line for each effect: its size, the
// decision and the reason.
std::string PlanText(const Plan& plan);

// Returns the words of the effects whose omission may change the answer.
std::vector<std::string> LeftOut(const Plan& plan);

// Returns a line that names these effects and says what they may change; empty if there are none.
std::string LeftOutText(const Plan& plan);

// Returns a header and one row for each effect.
std::string PlanCsv(const Plan& plan);

}  // namespace ricochet::cli

#endif  // RICOCHET_CLIENT_CLI_REPORT_PLAN_REPORT_H_
