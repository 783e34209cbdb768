// Numbers as text.

#ifndef RICOCHET_CORE_BASE_DECIMAL_H_
#define RICOCHET_CORE_BASE_DECIMAL_H_

#include <array>
#include <charconv>
#include <cstddef>
#include <string>

namespace ricochet {

// Appends the shortest decimal that reads back as exactly `number`, a double or a 64-bit integer: "0.1", "1e-300",
// "inf", "nan".
template <typename Number>
void AppendDecimal(Number number, std::string& text) {
  std::array<char, 32> buffer;
  const char* const end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), number).ptr;
  text.append(buffer.data(), static_cast<size_t>(end - buffer.data()));
}

// Returns what AppendDecimal appends.
inline std::string ShortestDecimal(double value) {
  std::string text;
  AppendDecimal(value, text);
  return text;
}

}  // namespace ricochet

#endif  // RICOCHET_CORE_BASE_DECIMAL_H_
