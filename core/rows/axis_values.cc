#include "core/rows/axis_values.h"

#include <cmath>
#include <variant>

#include "core/numerics/elementary.h"

namespace ricochet {
namespace {

double ValueAt(std::monostate /*unset*/, int64_t /*i*/) { return 0.0; }
double ValueAt(const ListValues& list, int64_t i) { return list.values[static_cast<size_t>(i)]; }
// Rounds as numpy.linspace does, so that an axis that passes through 0 has the value 0 there, and scripts that make the
// same axis have the same bits.
double ValueAt(const Linspace& linspace, int64_t i) {
  if (i == 0) return linspace.start;
  if (i == linspace.count - 1) return linspace.stop;
  const auto place = static_cast<double>(i), steps = static_cast<double>(linspace.count - 1);
  const double way = linspace.stop - linspace.start, step = way / steps;
  if (!std::isfinite(way)) return std::lerp(linspace.start, linspace.stop, place / steps);
  return (step == 0.0 ? place / steps * way : place * step) + linspace.start;
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
