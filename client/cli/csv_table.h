// Tables of numbers as CSV text with a header.

#ifndef RICOCHET_CLIENT_CLI_CSV_TABLE_H_
#define RICOCHET_CLIENT_CLI_CSV_TABLE_H_

#include <string>
#include <vector>

#include "absl/status/statusor.h"

namespace ricochet::cli {

struct CsvTable {
  std::vector<std::string> header;
  std::vector<std::vector<double>> columns;  // One for each name of the header, all equally long.
};

// Reads a table. A cell may stand in double quotes; one that is missing or not a number becomes a NaN. Cells beyond the
// header, empty lines, lines that start with # and a byte order mark are skipped. `name` names the table in errors.
// Errors: INVALID_ARGUMENT if there is no header, or if it has semicolons.
absl::StatusOr<CsvTable> ParseCsvTable(const std::string& text, const std::string& name);

}  // namespace ricochet::cli

#endif  // RICOCHET_CLIENT_CLI_CSV_TABLE_H_
