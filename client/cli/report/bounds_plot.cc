#include "client/cli/report/bounds_plot.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/types/span.h"
#include "client/cli/text/enum_names.h"

namespace ricochet::cli {
namespace {

struct Quantity {
  const char* name;
  Range CoefficientBounds::*range;
};

constexpr std::array kCoefficients = {
    Quantity{"Newton", &CoefficientBounds::newton}, Quantity{"Poisson", &CoefficientBounds::poisson},
    Quantity{"energetic", &CoefficientBounds::energetic}, Quantity{"tangential", &CoefficientBounds::tangential}};
constexpr std::array kImpulses = {Quantity{"normal impulse", &CoefficientBounds::normal_total_n_s}};

// A set of ranges of the answer.
struct Ranges {
  const char* title;
  const char* colour;
  CoefficientBounds bounds;
};

std::vector<Ranges> RangesOf(const BoundsResponse& response) {
  const Bounds& bounds = response.bounds;
  std::vector<Ranges> all = {{bounds.sampled ? "found by a sample" : "sharp (spring)", "#0072B2", bounds.sharp}};
  if (bounds.energy_only.has_value()) all.push_back({"energy only", "#D55E00", *bounds.energy_only});
  if (bounds.nearly_vertical.has_value()) {
    all.push_back({"first order in x", "#009E73", bounds.nearly_vertical->bounds});
  }
  if (response.enclosure.has_value()) {
    all.push_back({"guaranteed range", "#CC79A7", response.enclosure->outer});
    all.push_back({"range found", "#56B4E9", response.enclosure->attained});
  }
  return all;
}

// Returns the finite ends of all ranges, at least one number apart.
Range Finite(const std::vector<Ranges>& all, absl::Span<const Quantity> quantities) {
  Range finite;
  for (const Ranges& ranges : all) {
    for (const Quantity& quantity : quantities) {
      const Range& range = ranges.bounds.*quantity.range;
      if (std::isfinite(range.lower)) finite.lower = std::min(finite.lower, range.lower);
      if (std::isfinite(range.upper)) finite.upper = std::max(finite.upper, range.upper);
    }
  }
  if (finite.lower == finite.upper) finite.upper = finite.lower + 1.0;
  return finite;
}

// Bars of one quantity stand one below the other, around the place of its name.
Panel PanelOf(const std::vector<Ranges>& all, absl::Span<const Quantity> quantities) {
  Panel panel;
  const Range finite = Finite(all, quantities);
  const double beyond = 0.08 * (finite.upper - finite.lower);
  Curve infinite{
      .title = "infinite", .points = {}, .style = "with points pointtype 9 pointsize 1.8 linecolor rgb 'red'"};
  for (size_t i = 0; i < all.size(); ++i) {
    Curve bars{.title = all[i].title,
               .points = {},
               .style = absl::StrCat("with linespoints linewidth 5 pointtype 5 pointsize 0.7 linecolor rgb '",
                                     all[i].colour, "'")};
    for (size_t q = 0; q < quantities.size(); ++q) {
      const Range& range = all[i].bounds.*quantities[q].range;
      if (!(range.lower <= range.upper)) continue;  // An enclosure of no valid scene is empty.
      const double y = static_cast<double>(quantities.size() - q) + 0.3 -
                       0.6 * (static_cast<double>(i) + 0.5) / static_cast<double>(all.size());
      const double lower = std::isfinite(range.lower) ? range.lower : finite.lower - beyond;
      const double upper = std::isfinite(range.upper) ? range.upper : finite.upper + beyond;
      if (!std::isfinite(range.lower)) infinite.points.emplace_back(lower, y);
      if (!std::isfinite(range.upper)) infinite.points.emplace_back(upper, y);
      bars.points.emplace_back(lower, y);
      bars.points.emplace_back(upper, y);
      bars.points.emplace_back(NAN, NAN);
    }
    panel.curves.push_back(std::move(bars));
  }
  for (size_t q = 0; q < quantities.size(); ++q) {
    panel.y_ticks.push_back({static_cast<double>(quantities.size() - q), quantities[q].name});
  }
  if (!infinite.points.empty()) panel.curves.push_back(std::move(infinite));
  return panel;
}

}  // namespace

Plot BoundsPlot(const BoundsResponse& response) {
  const std::vector<Ranges> all = RangesOf(response);
  Panel coefficients = PanelOf(all, kCoefficients);
  coefficients.title = "Coefficients of restitution";
  coefficients.x_label = "coefficient";
  Panel impulse = PanelOf(all, kImpulses);
  impulse.title = "Normal impulse";
  impulse.x_label = "normal impulse [N s]";
  return {.title = absl::StrCat("Bounds; the elastic impact: ", RegimeText(response.bounds.regime)),
          .panels = {std::move(coefficients), std::move(impulse)}};
}

}  // namespace ricochet::cli
