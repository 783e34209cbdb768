// A grade as text, CSV, JSON and HTML.

#ifndef RICOCHET_CLIENT_CLI_CONFORMANCE_GRADE_REPORT_H_
#define RICOCHET_CLIENT_CLI_CONFORMANCE_GRADE_REPORT_H_

#include <string>

#include "client/cli/conformance/grade.h"

namespace ricochet::cli {

// Returns a summary by family, and each case that is not right or breaks a limit with the reasons.
std::string GradeText(const Grade& grade);
// Returns one row a case.
std::string GradeCsv(const Grade& grade);
std::string GradeJson(const Grade& grade);
// Returns the summary and a table of all cases, as a page that needs nothing beside it.
std::string GradePage(const Grade& grade);

// Returns "12 of 111 cases are right to 1e-09".
std::string GradeVerdict(const Grade& grade);

}  // namespace ricochet::cli

#endif  // RICOCHET_CLIENT_CLI_CONFORMANCE_GRADE_REPORT_H_
