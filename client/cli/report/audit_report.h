// The answers of `ricochet audit` as text and CSV.

#ifndef RICOCHET_CLIENT_CLI_REPORT_AUDIT_REPORT_H_
#define RICOCHET_CLIENT_CLI_REPORT_AUDIT_REPORT_H_

#include <string>

#include "client/cli/io/csv_row.h"
#include "ricochet/solver.h"

namespace ricochet::cli {

// Returns in words by how much a limit is broken: "the kinetic energy grows by 0.1 J".
std::string BrokenLimitText(AuditLimit limit, const std::string& excess);

// Returns tables with units, to six digits. `directions` is the number of tangential directions, 1 or 2.
std::string AuditText(const AuditResponse& response, size_t directions);

// Returns the row of one audit as CSV, at full precision. Its columns are named as the fields of
// ricochet.v1.AuditReport; an invalid row has no numbers.
CsvRow AuditCsvRow(const AuditReport& report, size_t directions);

// Returns the summary of many rows as a table. Row numbers start at 0.
std::string AuditSummaryText(const AuditSummary& summary);

// Returns in words what is wrong with a row: `invalid_reason` if it is invalid, else the limits that it breaks and by
// how much. Empty for an admissible row.
std::string AuditComplaint(const AuditReport& report, const std::string& invalid_reason);

}  // namespace ricochet::cli

#endif  // RICOCHET_CLIENT_CLI_REPORT_AUDIT_REPORT_H_
