#include "client/cli/io/csv_row.h"

#include "absl/strings/str_replace.h"

namespace ricochet::cli {

std::string CsvQuoted(const std::string& text) {
  return absl::StrCat("\"", absl::StrReplaceAll(text, {{"\"", "\"\""}}), "\"");
}

std::string CsvOf(absl::Span<const CsvRow> rows) {
  std::string text;
  for (const CsvRow& row : rows) {
    if (text.empty()) absl::StrAppend(&text, row.Names(), "\n");
    absl::StrAppend(&text, row.Values(), "\n");
  }
  return text;
}

void AppendCsv(const std::string& words, std::string& text) {
  if (words.find_first_of(",\"\n") == std::string::npos) {
    text += words;
  } else {
    text += CsvQuoted(words);
  }
}

}  // namespace ricochet::cli
