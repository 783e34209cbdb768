// RowWriter: rows of cells as a table for people, as CSV, as the lists of a JSON document, or as objects of JSON, one
// on each line.

#ifndef RICOCHET_CLIENT_CLI_IO_ROW_WRITER_H_
#define RICOCHET_CLIENT_CLI_IO_ROW_WRITER_H_

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "client/cli/io/output_format.h"
#include "client/cli/text/json_text.h"
#include "client/cli/text/table.h"
#include "core/base/decimal.h"
#include "ricochet/regime.h"

namespace ricochet::cli {

// The cells of a row come from a visitor, in the order of the columns. Rows are appended to the caller's text as they
// come, except those of a table for people, whose widths are known at the end.
class RowWriter {
 public:
  // `format` is kText, kCsv, kJson or kJsonLines.
  RowWriter(Format format, const std::vector<std::string>& columns);

  // Appends what stands before the first row: the names of the columns as CSV, or the bracket that opens the lists. A
  // writer whose first row follows those of an earlier run does without it.
  void Begin(std::string& text);

  // Appends a row: calls `visit(*this)`, which gives its cells by the functions below.
  template <typename Visit>
  void Add(std::string& text, Visit visit) {
    BeginRow(text);
    visit(*this);
    EndRow();
  }

  // Appends what stands after the last row: the table, or the bracket that closes the lists.
  void End(std::string& text) const;

  // A number: rounded in a table, else so that it reads back as the same one.
  void Number(double value) {
    if (format_ == Format::kText) return cells_.push_back(Rounded(value));
    BeginCell();
    format_ == Format::kCsv ? AppendDecimal(value, *text_) : AppendJson(value, *text_);
  }
  void Integer(int64_t value) {
    if (format_ == Format::kText) return cells_.push_back(std::to_string(value));
    BeginCell();
    AppendDecimal(value, *text_);
  }
  void Words(const std::string& words);
  // In words in a table, else by its name.
  void Kind(Regime regime);

 private:
  void BeginRow(std::string& text);
  void EndRow();
  // Begins a cell: appends a comma, and the name of the column if each cell has its own.
  void BeginCell() {
    if (place_ > 0) text_->push_back(',');
    if (format_ == Format::kJsonLines) *text_ += names_[place_];
    ++place_;
  }

  Format format_;
  std::vector<std::string> names_;  // Each is written for CSV, or for JSON with a colon.
  size_t place_ = 0;                // The column of the next cell.
  std::string* text_ = nullptr;     // The row at hand is appended to it.
  bool is_first_row_ = false;
  Table table_;
  std::vector<std::string> cells_;  // A table takes the cells of a row at once.
};

}  // namespace ricochet::cli

#endif  // RICOCHET_CLIENT_CLI_IO_ROW_WRITER_H_
