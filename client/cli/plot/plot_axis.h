// Axes of plots: the range that shows all values, and labels that have room beside each other.

#ifndef RICOCHET_CLIENT_CLI_PLOT_PLOT_AXIS_H_
#define RICOCHET_CLIENT_CLI_PLOT_PLOT_AXIS_H_

#include <cstddef>
#include <string>
#include <vector>

namespace ricochet::cli {

// Positive numbers below this are 0 on a linear axis, and cannot be shown on a logarithmic one.
inline constexpr double kLeastOnAxis = 1e-300;

struct AxisRange {
  double lower = 0.0;
  double upper = 1.0;
  friend bool operator==(const AxisRange&, const AxisRange&) = default;
};

struct Tick {
  double at = 0.0;
  std::string label;
  friend bool operator==(const Tick&, const Tick&) = default;
};

// Returns the range of an axis for values from `least` to `most`, with `margin` of their distance on both sides. Values
// that differ by no more than `noise`, or by the rounding of a few operations, are drawn as one value: their range is
// that of a tenth of the value, so that rounding does not look like a step. On a logarithmic axis both ends are > 0.
AxisRange RangeFor(double least, double most, double margin, double noise, bool log);

// Returns 1, 2 or 5 times a power of ten as steps of the axis, as fine as there is room for: an axis is `length` pixels
// long. Labels stand side by side along it, so that each needs `character` pixels for each character and two more; or,
// if `stacked`, one above the other, so that each needs four times `character` pixels. A logarithmic axis has powers
// of ten, if at least two of them lie in the range. The steps of a linear axis are at least `least_step`.
std::vector<Tick> TicksFor(const AxisRange& range, double length, double character, bool stacked, bool log,
                           double least_step = 0.0);

// Returns the characters of the longest label.
size_t Widest(const std::vector<Tick>& ticks);

// Returns "10⁻³"; "1" for 0.
std::string PowerOfTen(int exponent);

// Returns the number with six significant digits, "1670" or "2.5×10⁻⁵".
std::string NumberText(double value);

}  // namespace ricochet::cli

#endif  // RICOCHET_CLIENT_CLI_PLOT_PLOT_AXIS_H_
