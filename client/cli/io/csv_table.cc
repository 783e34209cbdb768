#include "client/cli/io/csv_table.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "absl/strings/ascii.h"
#include "absl/strings/escaping.h"
#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_replace.h"
#include "client/cli/text/number_input.h"
#include "core/base/counted.h"
#include "core/base/nearest.h"
#include "core/base/try.h"

namespace ricochet::cli {
namespace {

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

// Reads a cell into `value`. Returns what is wrong with it; empty if it is a number.
std::string ReadCell(const std::string& cell, CellKind kind, double& value) {
  if (cell.empty()) return "is missing";
  const std::string rule = ReadNumber(cell, kind == CellKind::kAngle ? Spelling::kAngle : Spelling::kNumber, value);
  return rule.empty() ? "" : absl::StrCat("= \"", absl::CEscape(cell), "\": must ", rule);
}

}  // namespace

absl::StatusOr<bool> CsvReader::NextLine() {
  std::string more;
  while (ReadLine(line_)) {
    if (lines_read_ == 1 && absl::StartsWith(line_, kByteOrderMark)) line_.erase(0, sizeof(kByteOrderMark) - 1);
    absl::StripAsciiWhitespace(&line_);
    if (line_.empty() || line_[0] == '#') continue;
    number_ = lines_read_;
    // A line may end within a cell in quotes.
    const auto is_open = [](const std::string& text) { return std::count(text.begin(), text.end(), '"') % 2 != 0; };
    bool in_quotes = is_open(line_);
    for (; in_quotes && ReadLine(more); in_quotes ^= is_open(more)) absl::StrAppend(&line_, "\n", more);
    if (!in_quotes) return true;
    return absl::InvalidArgumentError(absl::StrCat(
        name_, ", line ", number_,
        " begins a cell in quotes that does not end, which has all lines after it: must have a quote at its end"));
  }
  return false;
}

bool CsvReader::ReadLine(std::string& line) {
  if (!std::getline(*stream_, line)) return false;
  bytes_ += static_cast<int64_t>(line.size()) + 1;
  ++lines_read_;
  return true;
}

std::string CsvReader::WhyNoRow(const std::vector<std::string>& cells) const {
  if (cells.size() == header_.size()) return "";
  return absl::StrCat("has ", Counted(cells.size(), "cell"), ": must have ", header_.size(),
                      cells.size() < header_.size() ? "; what is unknown has an empty cell"
                                                    : "; a number has a decimal point, not a comma");
}

void CsvReader::Append(const std::vector<std::string>& cells, CsvTable& table) const {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  BadCells bad{.row = table.columns.front().size(), .column = {}, .description = WhyNoRow(cells)};
  const bool fits = bad.description.empty();
  for (size_t i = 0; i < table.columns.size(); ++i) {
    double value = kNone;
    const std::string wrong = !fits || IsSkipped(i) ? "" : ReadCell(cells[i], kinds_[i], value);
    table.columns[i].push_back(wrong.empty() ? value : kNone);
    if (wrong.empty() || !bad.description.empty()) continue;
    bad.column = header_[i];
    bad.description = wrong;
  }
  if (!bad.description.empty()) table.bad.push_back(std::move(bad));
}

absl::Status RefuseUtf16(absl::string_view text, const std::string& name) {
  if (!absl::StartsWith(text, "\xFF\xFE") && !absl::StartsWith(text, "\xFE\xFF")) return absl::OkStatus();
  return absl::InvalidArgumentError(absl::StrCat(name, " is in UTF-16: must be in UTF-8"));
}

absl::StatusOr<CsvReader> CsvReader::Open(std::istream& stream, const std::string& name) {
  CsvReader reader(stream, name);
  const absl::StatusOr<bool> has_header = reader.NextLine();
  // In UTF-16 quotes mean nothing yet.
  if (absl::Status status = RefuseUtf16(reader.line_, name); !status.ok()) return status;
  if (absl::StartsWith(reader.line_, "\x93NUMPY")) {
    return absl::InvalidArgumentError(absl::StrCat(name, " is an array of NumPy: must be CSV with a header"));
  }
  if (!has_header.ok()) return has_header.status();
  if (!*has_header) return absl::InvalidArgumentError(absl::StrCat(name, " has no header"));
  for (const auto& [separator, plural] : {std::pair(';', "semicolons"), std::pair('\t', "tabs")}) {
    if (!absl::StrContains(reader.line_, separator)) continue;
    return absl::InvalidArgumentError(
        absl::StrCat(name, " separates its columns by ", plural, ": must use commas, and decimal points in numbers"));
  }
  Split(reader.line_, reader.header_);
  reader.kinds_.resize(reader.header_.size());
  return reader;
}

absl::Status CsvReader::Skip(const std::vector<std::string>& names) {
  for (const std::string& name : names) {
    if (std::find(header_.begin(), header_.end(), name) == header_.end()) {
      return absl::InvalidArgumentError(
          absl::StrCat("--skip-column = ", name, ": must be a column of ", name_, DidYouMean(name, header_)));
    }
    for (size_t i = 0; i < header_.size(); ++i) {
      if (header_[i] == name) kinds_[i] = CellKind::kSkipped;
    }
  }
  if (std::any_of(kinds_.begin(), kinds_.end(), [](CellKind kind) { return kind != CellKind::kSkipped; })) {
    return absl::OkStatus();
  }
  return absl::InvalidArgumentError(absl::StrCat(name_, " has no column that is not left out"));
}

void CsvReader::Define(size_t column, std::string name, CellKind kind) {
  header_[column] = std::move(name);
  kinds_[column] = kind;
}

absl::StatusOr<bool> CsvReader::NextRow(std::vector<std::string>& cells) {
  absl::StatusOr<bool> has_row = NextLine();
  if (has_row.ok() && *has_row) Split(line_, cells);
  return has_row;
}

absl::StatusOr<CsvTable> CsvReader::Next(size_t most) {
  CsvTable table{.header = header_, .columns = {}, .lines = {}, .bad = {}};
  table.columns.resize(header_.size());
  std::vector<std::string> cells;
  while (table.lines.size() < most) {
    RICOCHET_TRY(const bool has_row, NextRow(cells));
    if (!has_row) break;
    table.lines.push_back(number_);
    Append(cells, table);
  }
  return table;
}

}  // namespace ricochet::cli
