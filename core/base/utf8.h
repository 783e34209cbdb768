// Texts of others, which may have bytes that are not UTF-8.

#ifndef RICOCHET_CORE_BASE_UTF8_H_
#define RICOCHET_CORE_BASE_UTF8_H_

#include <cstddef>
#include <string>
#include <string_view>

namespace ricochet {

// Returns the number of bytes of the UTF-8 character that starts at `i`, or 0 if none does.
size_t Utf8Length(std::string_view text, size_t i);

// Returns the text with U+FFFD in place of each byte that is not UTF-8 and of each control character other than a tab
// and a line feed: XML can have neither.
std::string Printable(std::string_view text);

inline constexpr size_t kMostExcerpt = 80;

// Returns the first kMostExcerpt bytes of a text, with escapes for all that is not printable ASCII, and "..." where
// there are more.
std::string Excerpt(const std::string& text);

}  // namespace ricochet

#endif  // RICOCHET_CORE_BASE_UTF8_H_
