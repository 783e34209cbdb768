// What `ricochet audit` prints.

#ifndef RICOCHET_CLIENT_CLI_AUDIT_REPORT_H_
#define RICOCHET_CLIENT_CLI_AUDIT_REPORT_H_

#include <string>

#include "ricochet/solver.h"

namespace ricochet::cli {

// `directions` tangential ones are shown, 1 or 2.
std::string AuditText(const AuditResponse& response, size_t directions);

// A header and one row an audit, at full precision.
std::string AuditCsvHeader(size_t directions);
std::string AuditCsvRow(const AuditReport& report, size_t directions);

// What there was in many rows. Indices count from 0.
std::string AuditSummaryText(const AuditSummary& summary);

}  // namespace ricochet::cli

#endif  // RICOCHET_CLIENT_CLI_AUDIT_REPORT_H_
