// Tables of observed impacts: CSV text with a header.

#ifndef RICOCHET_CLIENT_CLI_AUDIT_DATA_H_
#define RICOCHET_CLIENT_CLI_AUDIT_DATA_H_

#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "ricochet/audit.h"

namespace ricochet::cli {

// Reads a table. Columns are named as the fields of AuditColumns (rates_after_rad_s[0] and so on, one for each link)
// and may come in any order. A cell may stand in double quotes; one that is missing or not a number becomes a NaN, which
// makes its row invalid but no other. Empty lines, lines that start with # and a byte order mark are skipped. `name` names
// the table in errors. Columns named in `skipped` are left out.
// Errors: INVALID_ARGUMENT for a header that names an unknown column or one twice, leaves out a link, has semicolons
// or lacks a column of `skipped`.
absl::StatusOr<AuditColumns> ParseAuditData(const std::string& text, const std::string& name,
                                            const std::vector<std::string>& skipped = {});

// Returns the rows [first, end). Each column must be empty or have a value for every row.
AuditColumns SomeRows(const AuditColumns& columns, size_t first, size_t end);

// Returns the length of the longest column.
size_t RowCount(const AuditColumns& columns);

}  // namespace ricochet::cli

#endif  // RICOCHET_CLIENT_CLI_AUDIT_DATA_H_
