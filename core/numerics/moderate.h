// AreModerate: whether every number is 0 or has a magnitude in [1/limit, limit], so that the products of a closed form
// stay within the range of doubles.

#ifndef RICOCHET_CORE_NUMERICS_MODERATE_H_
#define RICOCHET_CORE_NUMERICS_MODERATE_H_

#include <bit>
#include <cmath>
#include <cstdint>
#include <initializer_list>

namespace ricochet {

// The limit is a power of two above 1. NaN is not moderate.
template <typename Numbers>
bool AreModerate(const Numbers& numbers, double limit) {
  const auto least = std::bit_cast<uint64_t>(1.0 / limit);
  const auto most = std::bit_cast<uint64_t>(limit);
  bool moderate = true;
  for (const double number : numbers) {
    // The bits of positive numbers are in the order of their values.
    const auto size = std::bit_cast<uint64_t>(std::fabs(number));
    moderate &= (size == 0) | (size - least <= most - least);
  }
  return moderate;
}

inline bool AreModerate(std::initializer_list<double> numbers, double limit) {
  return AreModerate<std::initializer_list<double>>(numbers, limit);
}

}  // namespace ricochet

#endif  // RICOCHET_CORE_NUMERICS_MODERATE_H_
