#include "client/cli/plot/plot_map.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "core/base/decimal.h"

namespace ricochet::cli {
namespace {

// Viridis, whose lightness grows evenly with the value, so that the colour-blind and black-and-white print show it,
// too.
constexpr char kPalette[] =
    "set palette defined (0 '#440154', 1 '#472d7b', 2 '#3b528b', 3 '#2c728e', 4 '#21918c', 5 '#28ae80', 6 '#5ec962', "
    "7 '#addc30', 8 '#fde725')\n";

// The ends of the cell around each value of an axis.
class Borders {
 public:
  Borders(std::vector<double> values, bool log) : values_(std::move(values)) {
    std::sort(values_.begin(), values_.end());
    values_.erase(std::unique(values_.begin(), values_.end()), values_.end());
    const size_t count = values_.size();
    for (size_t i = 0; i + 1 < count; ++i) borders_.push_back(Between(values_[i], values_[i + 1], 0.5, log));
    // The cells at the ends reach as far outwards as inwards. A single value has no distance to its neighbours.
    const double first =
        count > 1 ? Between(values_[0], values_[1], -0.5, log) : values_[0] - (log ? 0.5 * values_[0] : 0.5);
    const double last =
        count > 1 ? Between(values_[count - 2], values_[count - 1], 1.5, log) : values_[0] + (log ? values_[0] : 0.5);
    borders_.insert(borders_.begin(), first);
    borders_.push_back(last);
  }

  std::pair<double, double> Around(double value) const {
    const auto found = std::lower_bound(values_.begin(), values_.end(), value) - values_.begin();
    const auto i = static_cast<size_t>(found);
    return {borders_[i], borders_[i + 1]};
  }

 private:
  static double Between(double a, double b, double fraction, bool log) {
    return log ? a * std::pow(b / a, fraction) : a + fraction * (b - a);
  }

  std::vector<double> values_;
  std::vector<double> borders_;  // One more than values.
};

void AppendBlock(const std::string& name, const std::vector<MapCell>& cells, std::string& script) {
  absl::StrAppend(&script, "$", name, " << EOD\n");
  for (const MapCell& cell : cells) {
    const std::vector<double> numbers = {cell.left, cell.right, cell.bottom, cell.top, cell.value};
    const auto append = [](std::string* text, double number) { absl::StrAppend(text, ShortestDecimal(number)); };
    absl::StrAppend(&script, absl::StrJoin(numbers, " ", append), "\n");
  }
  absl::StrAppend(&script, "EOD\n");
}

}  // namespace

std::vector<MapCell> CellsOf(const std::vector<MapPoint>& points, bool log_x, bool log_y) {
  std::vector<MapPoint> shown;
  std::vector<double> xs;
  std::vector<double> ys;
  for (const MapPoint& point : points) {
    if ((log_x && point.x <= 0.0) || (log_y && point.y <= 0.0)) continue;
    shown.push_back(point);
    xs.push_back(point.x);
    ys.push_back(point.y);
  }
  if (shown.empty()) return {};
  std::stable_sort(shown.begin(), shown.end(),
                   [](const MapPoint& a, const MapPoint& b) { return std::pair(a.y, a.x) < std::pair(b.y, b.x); });
  const Borders across(std::move(xs), log_x);
  const Borders up(std::move(ys), log_y);
  std::vector<MapCell> cells;
  for (const MapPoint& point : shown) {
    const auto [left, right] = across.Around(point.x);
    const auto [bottom, top] = up.Around(point.y);
    cells.push_back({left, right, bottom, top, point.value, point.is_jammed});
  }
  return cells;
}

std::vector<std::string> LegendOfCells(const std::vector<MapPoint>& points) {
  std::vector<std::string> names;
  const auto any = [&](auto is) { return std::any_of(points.begin(), points.end(), is); };
  if (any([](const MapPoint& point) { return std::isnan(point.value); })) names.emplace_back(kNoValue);
  if (any([](const MapPoint& point) { return point.is_jammed; })) names.emplace_back(kJammed);
  return names;
}

Scale ScaleOfCells(const std::vector<MapCell>& cells) {
  std::vector<double> values;
  for (const MapCell& cell : cells) {
    if (!cell.is_jammed) values.push_back(cell.value);
  }
  return ScaleFor({std::move(values)}, false);
}

std::vector<std::string> AppendCells(const std::string& name, const std::vector<MapCell>& cells, const AxisRange& range,
                                     std::string& script) {
  std::vector<MapCell> coloured;
  std::vector<MapCell> missing;
  std::vector<MapCell> jammed;
  double right_end = cells.empty() ? 0.0 : cells.back().right;
  double top_end = cells.empty() ? 0.0 : cells.back().top;
  for (const MapCell& cell : cells) {
    right_end = std::max(right_end, cell.right);
    top_end = std::max(top_end, cell.top);
    (cell.is_jammed ? jammed : std::isnan(cell.value) ? missing : coloured).push_back(cell);
  }
  for (MapCell& cell : coloured) {
    // A cell reaches under those that are drawn after it: no seam is seen where pixels lie across a border.
    cell.right = std::min(right_end, cell.right + 0.5 * (cell.right - cell.left));
    cell.top = std::min(top_end, cell.top + 0.5 * (cell.top - cell.bottom));
    cell.value = std::clamp(cell.value, range.lower, range.upper);
  }
  constexpr char kBoxes[] = " using (0.5*($1+$2)):(0.5*($3+$4)):1:2:3:4";
  constexpr char kSolid[] = " with boxxyerror fillstyle solid ";
  std::vector<std::string> parts;
  const auto add = [&](const char* kind, std::vector<MapCell>& of, const std::string& look) {
    if (of.empty()) return;
    AppendBlock(absl::StrCat(name, kind), of, script);
    parts.push_back(absl::StrCat("$", name, kind, kBoxes, look));
  };
  add("", coloured, absl::StrCat(":5", kSolid, "noborder linecolor palette notitle"));
  // A border covers the seams between cells of one colour.
  const auto plain = [&](const char* colour, const char* title) {
    return absl::StrCat(kSolid, "border rgb '", colour, "' linecolor rgb '", colour, "' linewidth 1 title '", title,
                        "'");
  };
  add("missing", missing, plain("#c8c8c8", kNoValue));
  add("jammed", jammed, plain(kJamColour, kJammed));
  return parts;
}

void AppendColours(const Scale& scale, const AxisRange& range, const std::string& ticks, const std::string& label,
                   std::string& script) {
  absl::StrAppend(&script, kPalette, "set cbrange [", ShortestDecimal(range.lower), ":", ShortestDecimal(range.upper),
                  "]\n", scale.log ? "set logscale cb\n" : "", ticks, "set cblabel ", label, " offset 2, 0\n",
                  scale.any ? "set colorbox\n" : "unset colorbox\n");
}

}  // namespace ricochet::cli
