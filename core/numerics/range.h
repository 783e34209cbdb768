// RangeOf: the least and the largest number of a column.

#ifndef RICOCHET_CORE_NUMERICS_RANGE_H_
#define RICOCHET_CORE_NUMERICS_RANGE_H_

#include <cstddef>

namespace ricochet {

struct Range {
  double least = 0.0;
  double most = 0.0;
};

// Returns the range of `count` numbers, at least one; NaN for both ends if any of them is NaN.
Range RangeOf(const double* numbers, size_t count);

}  // namespace ricochet

#endif  // RICOCHET_CORE_NUMERICS_RANGE_H_
