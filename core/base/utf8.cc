#include "core/base/utf8.h"

#include <algorithm>

#include "absl/strings/escaping.h"
#include "absl/strings/str_cat.h"

namespace ricochet {

size_t Utf8Length(std::string_view text, size_t i) {
  const auto byte = [text](size_t at) { return static_cast<unsigned char>(text[at]); };
  const unsigned char lead = byte(i);
  const size_t length = lead < 0x80 ? 1 : lead < 0xC2 ? 0 : lead < 0xE0 ? 2 : lead < 0xF0 ? 3 : lead < 0xF5 ? 4 : 0;
  if (length == 0 || i + length > text.size()) return 0;
  for (size_t k = 1; k < length; ++k) {
    if ((byte(i + k) & 0xC0U) != 0x80U) return 0;
  }
  // The second byte excludes overlong encodings, surrogates and code points above U+10FFFF.
  const bool barred = (lead == 0xE0 && byte(i + 1) < 0xA0) || (lead == 0xED && byte(i + 1) >= 0xA0) ||
                      (lead == 0xF0 && byte(i + 1) < 0x90) || (lead == 0xF4 && byte(i + 1) >= 0x90);
  return barred ? 0 : length;
}

std::string Printable(std::string_view text) {
  std::string printable;
  for (size_t i = 0, length = 0; i < text.size(); i += std::max<size_t>(length, 1)) {
    length = Utf8Length(text, i);
    const auto byte = static_cast<unsigned char>(text[i]);
    const bool is_control = (byte < 0x20 && byte != '\t' && byte != '\n') || byte == 0x7F;
    if (length == 0 || is_control) {
      printable += "\xEF\xBF\xBD";
    } else {
      printable.append(text, i, length);
    }
  }
  return printable;
}

std::string Excerpt(const std::string& text) {
  return absl::StrCat(absl::CEscape(text.substr(0, kMostExcerpt)), text.size() > kMostExcerpt ? "..." : "");
}

}  // namespace ricochet
