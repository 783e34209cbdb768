// Tables of observed impacts, as CSV with a header.

#ifndef RICOCHET_CLIENT_CLI_AUDIT_DATA_H_
#define RICOCHET_CLIENT_CLI_AUDIT_DATA_H_

#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "ricochet/audit.h"

namespace ricochet::cli {

// Columns are found by name, the fields of AuditColumns (rates_after_rad_s[0], one a link), in any order; a column of
// another name is left alone. What is no number, or missing, becomes a NaN, which makes its row invalid and no other.
// Empty lines and those that start with # are passed over.
// Errors: INVALID_ARGUMENT for a header that names a column twice, none that is known, or leaves out a link.
absl::StatusOr<AuditColumns> ParseAuditData(const std::string& text, const std::string& name);

// Rows [first, end) of columns that all have a value a row or none.
AuditColumns SomeRows(const AuditColumns& columns, size_t first, size_t end);

size_t RowCount(const AuditColumns& columns);

}  // namespace ricochet::cli

#endif  // RICOCHET_CLIENT_CLI_AUDIT_DATA_H_
