// The ranges of CoefficientBounds by their names.

#ifndef RICOCHET_CORE_TYPES_NAMED_RANGES_H_
#define RICOCHET_CORE_TYPES_NAMED_RANGES_H_

#include <array>

#include "ricochet/bounds.h"

namespace ricochet {

struct NamedRange {
  const char* name;
  Range CoefficientBounds::*range;
};
inline constexpr std::array kNamedRanges = {
    NamedRange{"newton", &CoefficientBounds::newton}, NamedRange{"poisson", &CoefficientBounds::poisson},
    NamedRange{"energetic", &CoefficientBounds::energetic}, NamedRange{"tangential", &CoefficientBounds::tangential},
    NamedRange{"normal_total_n_s", &CoefficientBounds::normal_total_n_s}};

}  // namespace ricochet

#endif  // RICOCHET_CORE_TYPES_NAMED_RANGES_H_
