// CsvRow: a row of CSV whose cells bring the names of their columns.

#ifndef RICOCHET_CLIENT_CLI_IO_CSV_ROW_H_
#define RICOCHET_CLIENT_CLI_IO_CSV_ROW_H_

#include <cstdint>
#include <optional>
#include <string>

#include "absl/strings/str_cat.h"
#include "absl/strings/string_view.h"
#include "absl/types/span.h"
#include "core/base/decimal.h"

namespace ricochet::cli {

// Returns the text as a cell in double quotes, which may have commas and quotes.
std::string CsvQuoted(const std::string& text);

// A value that is unset has an empty cell.
class CsvRow {
 public:
  // The shortest decimal that reads back as the same double.
  void Number(absl::string_view name, std::optional<double> value) {
    Words(name, value.has_value() ? ShortestDecimal(*value) : "");
  }
  void Integer(absl::string_view name, std::optional<int64_t> value) {
    Words(name, value.has_value() ? absl::StrCat(*value) : "");
  }
  void Truth(absl::string_view name, bool value) { Words(name, value ? "true" : "false"); }
  // Any text, in quotes.
  void Quoted(absl::string_view name, const std::string& words) { Words(name, CsvQuoted(words)); }
  // A text without commas and quotes.
  void Words(absl::string_view name, absl::string_view words) {
    absl::StrAppend(&values_, names_.empty() ? "" : ",", words);
    absl::StrAppend(&names_, names_.empty() ? "" : ",", name);
  }

  // Return the names and the values, separated by commas, without a line feed.
  const std::string& Names() const { return names_; }
  const std::string& Values() const { return values_; }

 private:
  std::string names_;
  std::string values_;
};

// Returns the names of the first row on a line, and each row on another. Rows have the same columns.
std::string CsvOf(absl::Span<const CsvRow> rows);

// Appends a text, in quotes if it has a comma, a quote or a line feed.
void AppendCsv(const std::string& words, std::string& text);

}  // namespace ricochet::cli

#endif  // RICOCHET_CLIENT_CLI_IO_CSV_ROW_H_
