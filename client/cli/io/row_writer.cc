#include "client/cli/io/row_writer.h"

#include <utility>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "client/cli/io/csv_row.h"
#include "client/cli/text/enum_names.h"
#include "client/cli/text/json_text.h"

namespace ricochet::cli {

RowWriter::RowWriter(Format format, const std::vector<std::string>& columns) : format_(format), names_(columns) {
  if (format == Format::kText) table_.Add(columns);
  if (format != Format::kJsonLines) return;
  for (std::string& name : names_) {
    std::string key;
    AppendJson(name, key);
    name = key + ":";
  }
}

void RowWriter::Begin(std::string& text) {
  is_first_row_ = true;
  if (format_ == Format::kCsv) absl::StrAppend(&text, absl::StrJoin(names_, ","), "\n");
  if (format_ == Format::kJson) text.push_back('[');
}

void RowWriter::BeginRow(std::string& text) {
  text_ = &text;
  place_ = 0;
  if (format_ == Format::kJson) text += is_first_row_ ? "\n[" : ",\n[";
  if (format_ == Format::kJsonLines) text.push_back('{');
  is_first_row_ = false;
}

void RowWriter::EndRow() {
  if (format_ == Format::kText) table_.Add(std::exchange(cells_, {}));
  if (format_ == Format::kCsv) text_->push_back('\n');
  if (format_ == Format::kJson) text_->push_back(']');
  if (format_ == Format::kJsonLines) *text_ += "}\n";
}

void RowWriter::End(std::string& text) const {
  if (format_ == Format::kText) text += table_.Render(0);
  if (format_ == Format::kJson) text += "\n]";
}

void RowWriter::Words(const std::string& words) {
  if (format_ == Format::kText) return cells_.push_back(words);
  BeginCell();
  format_ == Format::kCsv ? AppendCsv(words, *text_) : AppendJson(words, *text_);
}

void RowWriter::Kind(Regime regime) {
  format_ == Format::kText ? Words(RegimeText(regime)) : Words(RegimeName(regime));
}

}  // namespace ricochet::cli
