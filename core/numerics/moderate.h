// AreWithin: whether every number is 0 or has a magnitude in [least, most], so that the products of a closed form stay
// within the range of doubles.

#ifndef RICOCHET_CORE_NUMERICS_MODERATE_H_
#define RICOCHET_CORE_NUMERICS_MODERATE_H_

#include <bit>
#include <cmath>
#include <cstdint>
#include <initializer_list>

namespace ricochet {

// 0 < least < most. NaN is not within them.
template <typename Numbers>
bool AreWithin(double lower, double upper, const Numbers& numbers) {
  const auto least = std::bit_cast<uint64_t>(lower);
  const auto most = std::bit_cast<uint64_t>(upper);
  bool moderate = true;
  for (const double number : numbers) {
    // The bits of positive numbers are in the order of their values.
    const auto size = std::bit_cast<uint64_t>(std::fabs(number));
    moderate &= (size == 0) | (size - least <= most - least);
  }
  return moderate;
}

inline bool AreWithin(double least, double most, std::initializer_list<double> numbers) {
  return AreWithin<std::initializer_list<double>>(least, most, numbers);
}

// The range of magnitudes is [1/limit, limit]; `limit` is a power of two above 1.
template <typename Numbers>
bool AreModerate(const Numbers& numbers, double limit) {
  return AreWithin(1.0 / limit, limit, numbers);
}

inline bool AreModerate(std::initializer_list<double> numbers, double limit) {
  return AreModerate<std::initializer_list<double>>(numbers, limit);
}

}  // namespace ricochet

#endif  // RICOCHET_CORE_NUMERICS_MODERATE_H_
