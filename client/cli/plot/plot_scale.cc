#include "client/cli/plot/plot_scale.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <limits>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"

namespace ricochet::cli {
namespace {

constexpr size_t kLeastForAFew = 10;  // With fewer values none may lie outside the middle part.
constexpr size_t kFew = 20;           // On each side, one value in this many may lie outside the middle part.
constexpr double kFarBeyond = 4.0;    // Lengths of the middle part.
constexpr double kBeside = 0.25;
constexpr double kDecades = 30.0;
constexpr double kRounding = 64.0 * std::numeric_limits<double>::epsilon();

size_t AFewOf(size_t count) { return count < kLeastForAFew ? 0 : (count + kFew - 1) / kFew; }

// `values` must be in ascending order.
bool SpanDecades(const std::vector<double>& values) {
  if (values.size() < 3 || !(values.front() > 0.0)) return false;
  const size_t few = std::max<size_t>(1, AFewOf(values.size()));
  return values[values.size() / 3] < values[values.size() - 1 - few] / kDecades;
}

// Returns the multiple of the power of ten at or beyond `value`.
double RoundedOut(double value, int exponent, bool up) {
  const double power = std::pow(10.0, std::abs(exponent));
  const double scaled = exponent < 0 ? value * power : value / power;
  const double whole = up ? std::ceil(scaled) : std::floor(scaled);
  return exponent < 0 ? whole / power : whole * power;
}

// Returns the exponent of the second digit of a length.
int SecondDigit(double length) { return static_cast<int>(std::floor(std::log10(length))) - 1; }

// Widens `middle` to the middle part of a group, whose finite values are in ascending order.
void Hold(const std::vector<double>& values, AxisRange& middle) {
  if (values.empty()) return;
  const size_t few = AFewOf(values.size());
  middle.lower = std::min(middle.lower, values[few]);
  middle.upper = std::max(middle.upper, values[values.size() - 1 - few]);
}

// Returns how many of the places, in ascending order, lie before those that are far above the middle part.
size_t CountBelowTheFar(const std::vector<double>& places, double low, double high) {
  const double length = high - low;
  if (length <= kRounding * std::max(std::abs(low), std::abs(high))) return places.size();
  if (places.back() - high <= kFarBeyond * length) return places.size();
  const auto far = std::upper_bound(places.begin(), places.end(), high + kBeside * length);
  // A single far value may be a pole. Beside several far values, so short a middle part is only the rounding of zero.
  if (places.end() - far > 1 && length <= kRounding * std::abs(*far)) return places.size();
  return static_cast<size_t>(far - places.begin());
}

// Returns the ends for finite values in ascending order.
AxisRange EndsOf(const std::vector<double>& values, const AxisRange& middle, bool log) {
  const auto place = [log](double value) { return log ? std::log10(value) : value; };
  const double low = place(middle.lower);
  const double high = place(middle.upper);
  std::vector<double> places(values.size());
  std::transform(values.begin(), values.end(), places.begin(), place);
  const size_t below = CountBelowTheFar(places, low, high);
  std::transform(values.rbegin(), values.rend(), places.begin(), [&](double value) { return -place(value); });
  const size_t above = CountBelowTheFar(places, -high, -low);
  const auto rounded = [&](double value, bool up) {
    return RoundedOut(value, SecondDigit(log ? value : high - low), up);
  };
  AxisRange ends{values.front(), values.back()};
  if (below < values.size()) ends.upper = std::min(ends.upper, rounded(values[below - 1], true));
  if (above < values.size()) ends.lower = std::max(ends.lower, rounded(values[values.size() - above], false));
  return ends;
}

// Removes what the scale cannot show, and sorts the rest.
void Tidy(bool log_asked, std::vector<double>& values) {
  values.erase(std::remove_if(values.begin(), values.end(),
                              [=](double value) { return std::isnan(value) || (log_asked && value <= 0.0); }),
               values.end());
  std::sort(values.begin(), values.end());
}

std::vector<double> FiniteOf(const std::vector<double>& sorted) {
  std::vector<double> finite;
  std::copy_if(sorted.begin(), sorted.end(), std::back_inserter(finite),
               [](double value) { return std::isfinite(value); });
  return finite;
}

}  // namespace

Scale ScaleFor(std::vector<std::vector<double>> groups, bool log_asked) {
  std::vector<double> all;
  for (std::vector<double>& group : groups) {
    Tidy(log_asked, group);
    all.insert(all.end(), group.begin(), group.end());
  }
  std::sort(all.begin(), all.end());
  const std::vector<double> finite = FiniteOf(all);
  if (finite.empty()) return {.log = log_asked};
  const bool log = log_asked || (finite.size() == all.size() && SpanDecades(finite));
  AxisRange middle{finite.back(), finite.front()};
  for (const std::vector<double>& group : groups) Hold(FiniteOf(group), middle);
  const AxisRange ends = EndsOf(finite, middle, log);
  return {.any = true,
          .log = log,
          .least = ends.lower,
          .most = ends.upper,
          .count = static_cast<int64_t>(all.size()),
          .below = std::lower_bound(all.begin(), all.end(), ends.lower) - all.begin(),
          .above = all.end() - std::upper_bound(all.begin(), all.end(), ends.upper),
          .lowest = all.front(),
          .highest = all.back()};
}

AxisRange RangeOf(const Scale& scale, double margin, double noise) {
  AxisRange range = RangeFor(scale.least, scale.most, margin, noise, scale.log);
  if (scale.least == scale.most) return range;
  if (scale.below > 0) range.lower = scale.least;
  if (scale.above > 0) range.upper = scale.most;
  return range;
}

std::vector<Tick> WithMarkedEnds(std::vector<Tick> ticks, const Scale& scale, const AxisRange& range, double room) {
  const auto place = [&](double value) { return scale.log ? std::log10(value) : value; };
  const double reach = room * (place(range.upper) - place(range.lower));
  const auto mark = [&](double end, const char* relation) {
    const auto is_beside = [&](const Tick& tick) { return std::abs(place(tick.at) - place(end)) < reach; };
    ticks.erase(std::remove_if(ticks.begin(), ticks.end(), is_beside), ticks.end());
    ticks.push_back({end, absl::StrCat(relation, NumberText(end))});
  };
  if (scale.below > 0) mark(range.lower, "≤ ");
  if (scale.above > 0) mark(range.upper, "≥ ");
  return ticks;
}

std::string OutsideText(const Scale& scale) {
  std::vector<std::string> parts;
  const auto say = [&](int64_t count, const char* where, double end, const char* reach, double outermost) {
    if (count == 0) return;
    const std::string of_all = parts.empty() ? absl::StrCat(" of ", scale.count, " points") : "";
    parts.push_back(absl::StrCat(count, of_all, count == 1 ? " lies " : " lie ", where, " ", NumberText(end), ", ",
                                 reach, " ", NumberText(outermost)));
  };
  say(scale.above, "above", scale.most, "up to", scale.highest);
  say(scale.below, "below", scale.least, "down to", scale.lowest);
  return absl::StrJoin(parts, "; ");
}

}  // namespace ricochet::cli
