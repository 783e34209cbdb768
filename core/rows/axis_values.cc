#include "core/rows/axis_values.h"

#include <cmath>
#include <variant>

#include "core/numerics/elementary.h"

namespace ricochet {
namespace {

// Fills in the values from the `first` on, of which none is an end. Rounds as numpy.linspace does, so that an axis that
// passes through 0 has the value 0 there, and scripts that make the same axis have the same bits.
void FillBetween(const Linspace& linspace, int64_t first, absl::Span<double> values) {
  const double start = linspace.start, way = linspace.stop - start;
  const auto steps = static_cast<double>(linspace.count - 1);
  const double step = way / steps;
  const auto fill = [&](auto value_at) {
    for (size_t i = 0; i < values.size(); ++i)
      values[i] = value_at(static_cast<double>(first + static_cast<int64_t>(i)));
  };
  if (!std::isfinite(way)) return fill([&](double place) { return std::lerp(start, linspace.stop, place / steps); });
  if (step == 0.0) return fill([&](double place) { return place / steps * way + start; });
  fill([=](double place) { return place * step + start; });
}

double ValueAt(std::monostate /*unset*/, int64_t /*i*/) { return 0.0; }
double ValueAt(const ListValues& list, int64_t i) { return list.values[static_cast<size_t>(i)]; }
double ValueAt(const Linspace& linspace, int64_t i) {
  if (i == 0) return linspace.start;
  if (i == linspace.count - 1) return linspace.stop;
  double value = 0.0;
  FillBetween(linspace, i, absl::MakeSpan(&value, 1));
  return value;
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
void FillFrom(const Linspace& of, int64_t first, absl::Span<double> values) {
  FillBetween(of, first, values);
  const int64_t last = of.count - 1 - first;
  if (last < static_cast<int64_t>(values.size())) values[static_cast<size_t>(last)] = of.stop;
  if (first == 0 && !values.empty()) values.front() = of.start;  // The only value is this, too.
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
