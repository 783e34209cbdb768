// The values of an axis, which must be valid (core/types/grid.h).

#ifndef RICOCHET_CORE_ROWS_AXIS_VALUES_H_
#define RICOCHET_CORE_ROWS_AXIS_VALUES_H_

#include <cstdint>

#include "absl/types/span.h"
#include "ricochet/grid.h"

namespace ricochet {

// Value `i` of an axis, 0 <= i < AxisCount(axis). It has the same bits whatever part of the grid is asked for.
double AxisValue(const Axis& axis, int64_t i);

// Writes the values `first`, `first` + 1 ... of an axis, each with the bits of AxisValue.
void AxisValues(const Axis& axis, int64_t first, absl::Span<double> values);

}  // namespace ricochet

#endif  // RICOCHET_CORE_ROWS_AXIS_VALUES_H_
