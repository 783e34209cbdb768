#include "client/cli/plot/plot_axis.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <utility>

#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "client/cli/text/table.h"
#include "client/cli/text/wrap.h"

namespace ricochet::cli {
namespace {

// Values that differ by less than this fraction of the largest are equal but for rounding.
constexpr double kRounding = 64.0 * std::numeric_limits<double>::epsilon();

// The step m * 10^exponent of a linear axis.
struct Step {
  int mantissa;
  int exponent;
  double value() const { return mantissa * std::pow(10.0, exponent); }
};

Step Next(const Step& step) {
  switch (step.mantissa) {
    case 1:
      return {2, step.exponent};
    case 2:
      return {5, step.exponent};
    default:
      return {1, step.exponent + 1};
  }
}

// Returns count * step, rounded once.
double Multiple(int64_t count, const Step& step) {
  const auto scaled = static_cast<double>(count * step.mantissa);
  return step.exponent < 0 ? scaled / std::pow(10.0, -step.exponent) : scaled * std::pow(10.0, step.exponent);
}

// Returns the decimal number without an exponent, or a mantissa and a power of ten where that would be long. All labels
// of an axis have the same form.
std::string Label(int64_t count, const Step& step, double largest) {
  const int64_t scaled = count * step.mantissa;
  if (scaled == 0) return "0";
  if (largest < 1e6 && largest >= 1e-4 && step.exponent >= -5) {
    return absl::StrFormat("%.*f", std::max(0, -step.exponent), Multiple(count, step));
  }
  const int exponent = static_cast<int>(std::floor(std::log10(largest) + 1e-9));
  if (step.exponent <= exponent - 7) return absl::StrFormat("%.*f", std::max(0, -step.exponent), Multiple(count, step));
  const int digits = std::max(0, exponent - step.exponent);
  const double mantissa = static_cast<double>(scaled) * std::pow(10.0, step.exponent - exponent);
  return absl::StrCat(absl::StrFormat("%.*f", digits, mantissa), "×", PowerOfTen(exponent));
}

std::vector<Tick> LinearTicks(const AxisRange& range, const Step& step) {
  const double slack = 1e-9 * (range.upper - range.lower);
  const double largest = std::max(std::abs(range.lower), std::abs(range.upper));
  const auto first = static_cast<int64_t>(std::ceil((range.lower - slack) / step.value()));
  const auto last = static_cast<int64_t>(std::floor((range.upper + slack) / step.value()));
  std::vector<Tick> ticks;
  for (int64_t count = first; count <= last; ++count) {
    ticks.push_back({Multiple(count, step), Label(count, step, largest)});
  }
  return ticks;
}

double RoomFor(const std::vector<Tick>& ticks, double character, bool stacked) {
  if (stacked) return 4.0 * character;
  return (static_cast<double>(Widest(ticks)) + 2.0) * character;
}

// The ticks at every `every`-th power of ten; from ten on at the multiples of `every`.
std::vector<Tick> PowerTicks(int first, int last, int every) {
  std::vector<Tick> ticks;
  while (every >= 10 && first % every != 0) ++first;
  for (int exponent = first; exponent <= last; exponent += every) {
    ticks.push_back({std::pow(10.0, exponent), PowerOfTen(exponent)});
  }
  return ticks;
}

// The ticks at 1, 2 and 5 times the powers of ten, for a range without two powers of ten.
std::vector<Tick> ShortLogTicks(const AxisRange& range) {
  std::vector<Tick> ticks;
  for (Step step{1, static_cast<int>(std::floor(std::log10(range.lower)))}; step.value() <= range.upper * (1.0 + 1e-9);
       step = Next(step)) {
    if (step.value() >= range.lower * (1.0 - 1e-9)) ticks.push_back({step.value(), Rounded(step.value())});
  }
  return ticks;
}

// An axis has at least two labels, even if they are crowded. Ticks may lie outside of the range by its rounding.
std::vector<Tick> UnclampedTicks(const AxisRange& range, double length, double character, bool stacked, bool log,
                                 double least_step) {
  if (log) {
    const int first = static_cast<int>(std::ceil(std::log10(range.lower) - 1e-9));
    const int last = static_cast<int>(std::floor(std::log10(range.upper) + 1e-9));
    if (last > first) {
      const double decade = length / (std::log10(range.upper) - std::log10(range.lower));
      std::vector<Tick> ticks = PowerTicks(first, last, 1);
      for (int every = 1; every * decade < RoomFor(ticks, character, stacked);) {
        every += every < 10 ? 1 : 10 - every % 10;
        std::vector<Tick> fewer = PowerTicks(first, last, every);
        if (fewer.size() < 2) break;
        ticks = std::move(fewer);
      }
      return ticks;
    }
    std::vector<Tick> ticks = ShortLogTicks(range);
    if (ticks.size() > 1) return ticks;
  }
  const double width = range.upper - range.lower;
  // A hundredth of the range is finer than any label allows.
  Step step{1, static_cast<int>(std::floor(std::log10(width))) - 2};
  while (step.value() < least_step) step = Next(step);
  while (true) {
    std::vector<Tick> ticks = LinearTicks(range, step);
    if (length * step.value() / width >= RoomFor(ticks, character, stacked)) return ticks;
    const Step next = Next(step);
    if (LinearTicks(range, next).size() < 2) return ticks;
    step = next;
  }
}

}  // namespace

size_t Widest(const std::vector<Tick>& ticks) {
  size_t widest = 0;
  for (const Tick& tick : ticks) widest = std::max(widest, Characters(tick.label));
  return widest;
}

std::string PowerOfTen(int exponent) {
  static constexpr const char* kDigits[] = {"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
  if (exponent == 0) return "1";
  std::string text = exponent < 0 ? "10⁻" : "10";
  for (const char digit : absl::StrCat(std::abs(exponent))) text += kDigits[digit - '0'];
  return text;
}

std::string NumberText(double value) {
  std::string text = Rounded(value);
  const size_t mark = text.find('e');
  int exponent = 0;
  if (mark == std::string::npos || !absl::SimpleAtoi(text.substr(mark + 1), &exponent)) return text;
  return absl::StrCat(text.substr(0, mark), "×", PowerOfTen(exponent));
}

AxisRange RangeFor(double least, double most, double margin, double noise, bool log) {
  const double scale = std::max(std::abs(least), std::abs(most));
  if (most - least <= std::max({noise, kRounding * scale, log ? 0.0 : kLeastOnAxis})) {
    const double middle = least + 0.5 * (most - least);
    if (log) return {middle / 2.0, middle * 2.0};
    const double half = std::max({0.1 * scale, 10.0 * noise, scale < kLeastOnAxis ? 1.0 : 0.0});
    return {middle - half, middle + half};
  }
  if (log) {
    const double factor = std::exp(margin * (std::log(most) - std::log(least)));
    return {std::max(least / factor, std::numeric_limits<double>::min()),
            std::min(most * factor, std::numeric_limits<double>::max())};
  }
  const double distance = margin * (most - least);
  return {least - distance, most + distance};
}

std::vector<Tick> TicksFor(const AxisRange& range, double length, double character, bool stacked, bool log,
                           double least_step) {
  std::vector<Tick> ticks = UnclampedTicks(range, length, character, stacked, log, least_step);
  for (Tick& tick : ticks) tick.at = std::clamp(tick.at, range.lower, range.upper);
  return ticks;
}

}  // namespace ricochet::cli
