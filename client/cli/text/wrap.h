// Texts in lines: their width in characters, and breaks between words.

#ifndef RICOCHET_CLIENT_CLI_TEXT_WRAP_H_
#define RICOCHET_CLIENT_CLI_TEXT_WRAP_H_

#include <cstddef>
#include <string>

#include "absl/strings/string_view.h"

namespace ricochet::cli {

// Counts characters of UTF-8, not bytes.
size_t Characters(absl::string_view text);

// Says whether the words of a unit, such as "[N s]", stay together.
enum class Units { kBroken, kKept };

// Returns the text in lines of at most `width` characters, all but the first indented by `indent` spaces; the first
// begins at the column `start`. Words are never broken. There is no line feed at the end.
std::string WrapWords(absl::string_view text, size_t width, size_t start, size_t indent, Units units = Units::kBroken);

}  // namespace ricochet::cli

#endif  // RICOCHET_CLIENT_CLI_TEXT_WRAP_H_
