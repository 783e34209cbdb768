#include "client/cli/text/wrap.h"

#include <algorithm>

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_split.h"

namespace ricochet::cli {

size_t Characters(absl::string_view text) {
  // Continuation bytes of UTF-8 have no width.
  return static_cast<size_t>(
      std::count_if(text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U; }));
}

std::string WrapWords(absl::string_view text, size_t width, size_t start, size_t indent, Units units) {
  std::string wrapped;
  size_t line_start = start;
  size_t column = start;
  bool in_unit = false;
  for (const absl::string_view word : absl::StrSplit(text, ' ')) {
    if (column > line_start && !in_unit && column + 1 + Characters(word) > width) {
      absl::StrAppend(&wrapped, "\n", std::string(indent, ' '));
      column = line_start = indent;
    } else if (column > line_start) {
      wrapped += ' ';
      ++column;
    }
    absl::StrAppend(&wrapped, word);
    column += Characters(word);
    in_unit = units == Units::kKept && (in_unit || absl::StartsWith(word, "[")) && !absl::EndsWith(word, "]");
  }
  return wrapped;
}

}  // namespace ricochet::cli
