#include "core/rows/axis_values.h"

#include <cmath>
#include <variant>

#include "core/numerics/elementary.h"

namespace ricochet {
namespace {

// Computes i/(count - 1), which is exactly 0 and 1 at the ends.
double Fraction(int64_t i, int64_t count) {
  return count == 1 ? 0.0 : static_cast<double>(i) / static_cast<double>(count - 1);
}

double ValueAt(std::monostate /*unset*/, int64_t /*i*/) { return 0.0; }
double ValueAt(const ListValues& list, int64_t i) { return list.values[static_cast<size_t>(i)]; }
double ValueAt(const Linspace& linspace, int64_t i) {
  return std::lerp(linspace.start, linspace.stop, Fraction(i, linspace.count));
}
double ValueAt(const Logspace& logspace, const Linspace& logarithms, int64_t i) {
  if (i == 0) return logspace.start;
  if (i == logspace.count - 1) return logspace.stop;
  return Exp(ValueAt(logarithms, i));
}
Linspace LogarithmsOf(const Logspace& logspace) {
  return {.start = Log(logspace.start), .stop = Log(logspace.stop), .count = logspace.count};
}
double ValueAt(const Logspace& logspace, int64_t i) { return ValueAt(logspace, LogarithmsOf(logspace), i); }

template <typename Values>
void FillFrom(const Values& of, int64_t first, absl::Span<double> values) {
  for (size_t i = 0; i < values.size(); ++i) values[i] = ValueAt(of, first + static_cast<int64_t>(i));
}
void FillFrom(const Logspace& of, int64_t first, absl::Span<double> values) {
  const Linspace logarithms = LogarithmsOf(of);
  for (size_t i = 0; i < values.size(); ++i) values[i] = ValueAt(of, logarithms, first + static_cast<int64_t>(i));
}

}  // namespace

double AxisValue(const Axis& axis, int64_t i) {
  return std::visit([i](const auto& values) { return ValueAt(values, i); }, axis.values);
}

void AxisValues(const Axis& axis, int64_t first, absl::Span<double> values) {
  std::visit([first, values](const auto& of) { FillFrom(of, first, values); }, axis.values);
}

}  // namespace ricochet
