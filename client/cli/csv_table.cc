#include "client/cli/csv_table.h"

#include <limits>
#include <sstream>
#include <utility>

#include "absl/strings/ascii.h"
#include "absl/strings/escaping.h"
#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_replace.h"
#include "absl/strings/strip.h"
#include "client/cli/number_input.h"

namespace ricochet::cli {
namespace {

// Spreadsheets put it in front of a table in UTF-8.
constexpr char kByteOrderMark[] = "\xEF\xBB\xBF";

// Returns a cell without the blanks and the quotes around it. Two quotes within quotes stand for one.
std::string Unquoted(absl::string_view cell) {
  cell = absl::StripAsciiWhitespace(cell);
  if (cell.size() < 2 || cell.front() != '"' || cell.back() != '"') return std::string(cell);
  return std::string(
      absl::StripAsciiWhitespace(absl::StrReplaceAll(cell.substr(1, cell.size() - 2), {{"\"\"", "\""}})));
}

// Splits a line at its commas, except those within quotes.
void Split(const std::string& line, std::vector<std::string>& cells) {
  cells.clear();
  size_t start = 0;
  bool is_quoted = false;
  for (size_t i = 0; i <= line.size(); ++i) {
    if (i < line.size() && line[i] == '"') is_quoted = !is_quoted;
    if (i < line.size() && (line[i] != ',' || is_quoted)) continue;
    cells.push_back(Unquoted(absl::string_view(line).substr(start, i - start)));
    start = i + 1;
  }
}

std::string WhyNoNumber(const std::string& name, const std::string& cell) {
  if (cell.empty()) return absl::StrCat(name, " is missing");
  return absl::StrCat(name, " = \"", absl::CEscape(cell), "\": must be a number",
                      absl::StrContains(cell, ',') ? " with a decimal point, not a comma" : "");
}

}  // namespace

bool CsvReader::NextLine() {
  while (std::getline(*stream_, line_)) {
    bytes_ += static_cast<int64_t>(line_.size()) + 1;
    if (++number_ == 1 && absl::StartsWith(line_, kByteOrderMark)) line_.erase(0, sizeof(kByteOrderMark) - 1);
    absl::StripAsciiWhitespace(&line_);
    if (!line_.empty() && line_[0] != '#') return true;
  }
  return false;
}

void CsvReader::Append(const std::vector<std::string>& cells, CsvTable& table) const {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  const size_t row = table.columns.front().size();
  std::string reason;
  const bool fits = cells.size() <= header_.size();
  if (!fits) {
    reason = absl::StrCat("has ", cells.size(), " cells: must have ", header_.size(),
                          "; a number has a decimal point, not a comma");
  }
  for (size_t i = 0; i < table.columns.size(); ++i) {
    const bool is_read = fits && i < cells.size() && (skipped_.empty() || !skipped_[i]);
    const absl::StatusOr<double> number = is_read ? ParseNumber(cells[i], "") : kNone;
    table.columns[i].push_back(number.ok() ? *number : kNone);
    const bool is_bad = !number.ok() || (i >= cells.size() && (skipped_.empty() || !skipped_[i]));
    if (is_bad && reason.empty()) reason = WhyNoNumber(header_[i], i < cells.size() ? cells[i] : "");
  }
  if (!reason.empty()) table.bad.push_back({row, std::move(reason)});
}

absl::StatusOr<CsvReader> CsvReader::Open(std::istream& stream, const std::string& name) {
  CsvReader reader(stream);
  if (!reader.NextLine()) return absl::InvalidArgumentError(absl::StrCat(name, " has no header"));
  if (absl::StrContains(reader.line_, ';')) {
    return absl::InvalidArgumentError(
        absl::StrCat(name, " separates its columns by semicolons: must use commas, and decimal points in numbers"));
  }
  Split(reader.line_, reader.header_);
  return reader;
}

bool CsvReader::NextRow(std::vector<std::string>& cells) {
  if (!NextLine()) return false;
  Split(line_, cells);
  return true;
}

CsvTable CsvReader::Next(size_t most) {
  CsvTable table{.header = header_, .columns = {}, .lines = {}, .bad = {}};
  table.columns.resize(header_.size());
  std::vector<std::string> cells;
  while (table.lines.size() < most && NextRow(cells)) {
    table.lines.push_back(number_);
    Append(cells, table);
  }
  return table;
}

absl::StatusOr<CsvTable> ParseCsvTable(const std::string& text, const std::string& name) {
  std::istringstream stream(text);
  absl::StatusOr<CsvReader> reader = CsvReader::Open(stream, name);
  if (!reader.ok()) return reader.status();
  return reader->Next(std::numeric_limits<size_t>::max());
}

std::string CsvQuoted(const std::string& text) {
  return absl::StrCat("\"", absl::StrReplaceAll(text, {{"\"", "\"\""}}), "\"");
}

}  // namespace ricochet::cli
