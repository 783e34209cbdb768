#include "client/cli/csv_table.h"

#include <cstddef>
#include <limits>

#include "absl/strings/ascii.h"
#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_split.h"
#include "absl/strings/strip.h"
#include "client/cli/number_input.h"

namespace ricochet::cli {
namespace {

// Spreadsheets put it in front of a table in UTF-8.
constexpr char kByteOrderMark[] = "\xEF\xBB\xBF";

// Splits a line at its commas.
std::vector<std::string> Cells(const std::string& line) {
  std::vector<std::string> cells = absl::StrSplit(line, ',');
  for (std::string& cell : cells) {
    absl::StripAsciiWhitespace(&cell);
    const bool is_quoted = cell.size() >= 2 && cell.front() == '"' && cell.back() == '"';
    if (is_quoted) cell = cell.substr(1, cell.size() - 2);
  }
  return cells;
}

double NumberIn(const std::string& cell) {
  const absl::StatusOr<double> value = ParseNumber(cell, "");
  return value.ok() ? *value : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace

absl::StatusOr<CsvTable> ParseCsvTable(const std::string& text, const std::string& name) {
  CsvTable table;
  absl::string_view lines = text;
  absl::ConsumePrefix(&lines, kByteOrderMark);
  for (const auto line_view : absl::StrSplit(lines, '\n')) {
    const std::string line(absl::StripAsciiWhitespace(line_view));
    if (line.empty() || line[0] == '#') continue;
    const std::vector<std::string> cells = Cells(line);
    if (table.header.empty()) {
      if (absl::StrContains(line, ';')) {
        return absl::InvalidArgumentError(
            absl::StrCat(name, " separates its columns by semicolons: must use commas, and decimal points in numbers"));
      }
      table.header = cells;
      table.columns.resize(cells.size());
      continue;
    }
    for (size_t i = 0; i < table.columns.size(); ++i) {
      table.columns[i].push_back(NumberIn(i < cells.size() ? cells[i] : ""));
    }
  }
  if (table.header.empty()) return absl::InvalidArgumentError(absl::StrCat(name, " has no header"));
  return table;
}

}  // namespace ricochet::cli
