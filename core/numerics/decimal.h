// Doubles as text.

#ifndef RICOCHET_CORE_NUMERICS_DECIMAL_H_
#define RICOCHET_CORE_NUMERICS_DECIMAL_H_

#include <array>
#include <charconv>
#include <string>

namespace ricochet {

// The shortest decimal that reads back as exactly `value`: "0.1", "1e-300", "inf", "nan".
inline std::string ShortestDecimal(double value) {
  std::array<char, 32> buffer;
  const auto result = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value);
  return {buffer.data(), result.ptr};
}

}  // namespace ricochet

#endif  // RICOCHET_CORE_NUMERICS_DECIMAL_H_
