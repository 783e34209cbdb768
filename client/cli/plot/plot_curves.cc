#include "client/cli/plot/plot_curves.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <compare>
#include <cstddef>
#include <limits>
#include <set>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "absl/strings/str_replace.h"
#include "absl/strings/str_split.h"
#include "client/cli/plot/plot_map.h"
#include "core/base/decimal.h"
#include "core/base/utf8.h"

namespace ricochet::cli {
namespace {

// Okabe and Ito's colours, which the colour-blind can tell apart, without the yellow.
constexpr std::array kColours = {"#0072B2", "#D55E00", "#009E73", "#CC79A7", "#56B4E9", "#E69F00", "#000000"};
// After all colours the next dashes begin: 49 looks in all.
constexpr std::array kDashes = {"1", "'-'", "'.'", "'-.'", "'_ '", "'-..'", "'_.'"};

constexpr double kLineWidth = 2.0;
// A curve that later curves cover is drawn wider by this much for each of them, so that it still shows below them.
constexpr double kRibbon = 3.0;
constexpr int kMostRibbons = 4;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

std::string ColourOf(int look) { return kColours[static_cast<size_t>(look) % kColours.size()]; }

std::string LineStyle(int look, double width) {
  const size_t dash = static_cast<size_t>(look) / kColours.size() % kDashes.size();
  return absl::StrCat("with lines linewidth ", width, " dashtype ", kDashes[dash], " linecolor rgb '", ColourOf(look),
                      "'");
}

// A full circle, or a triangle up or down, by gnuplot's numbers.
enum class Mark { kCircle = 7, kUp = 9, kDown = 11 };

std::string MarkStyle(Mark mark, int look) {
  return absl::StrCat("with points pointtype ", static_cast<int>(mark), " pointsize ",
                      mark == Mark::kCircle ? 0.6 : 1.0, " linecolor rgb '", ColourOf(look), "'");
}

using Points = std::vector<std::pair<double, double>>;

// Returns the points of a curve without another shown point beside them: a line does not show them.
Points Isolated(const Points& points, const Axes& axes) {
  Points isolated;
  for (size_t i = 0; i < points.size(); ++i) {
    const auto joins = [&](const auto& other) { return axes.Shows(other) && other != points[i]; };
    const bool after = i > 0 && joins(points[i - 1]);
    const bool before = i + 1 < points.size() && joins(points[i + 1]);
    if (axes.Shows(points[i]) && !after && !before) isolated.push_back(points[i]);
  }
  return isolated;
}

int64_t Shown(const Points& points, const Axes& axes) {
  return std::count_if(points.begin(), points.end(), [&](const auto& point) { return axes.Shows(point); });
}

// Adds the first, the lowest, the highest and the last of some points.
void AddExtremes(Points::const_iterator first, Points::const_iterator end, Points& points) {
  const auto [lowest, highest] =
      std::minmax_element(first, end, [](const auto& a, const auto& b) { return a.second < b.second; });
  std::set<Points::const_iterator> kept = {first, lowest, highest, end - 1};
  for (const auto& point : kept) points.push_back(*point);
}

// Returns what a picture needs of a line that has several points in each pixel: of those that follow each other within
// a ten thousandth of the axis, the extremes.
Points Thinned(const Points& points, const Axes& axes) {
  constexpr size_t kFew = 20'000;
  constexpr double kPlaces = 10'000.0;
  if (points.size() <= kFew) return points;
  const auto place = [&axes](const auto& point) {
    return axes.Shows(point) ? std::floor(kPlaces * axes.Across(point.first)) : kNan;
  };
  Points thinned;
  for (auto first = points.begin(); first != points.end();) {
    const double here = place(*first);
    const auto end = std::find_if(first + 1, points.end(), [&](const auto& point) { return place(point) != here; });
    AddExtremes(first, end, thinned);
    first = end;
  }
  return thinned;
}

// Appends a block of data; an empty line ends a line of the picture.
void AppendData(const std::string& name, const Points& all, const Axes& axes, std::string& script) {
  absl::StrAppend(&script, "$", name, " << EOD\n");
  bool any = false;
  for (const auto& point : Thinned(all, axes)) {
    any = any || axes.Shows(point);
    absl::StrAppend(&script, axes.Shows(point)
                                 ? absl::StrCat(ShortestDecimal(point.first), " ", ShortestDecimal(point.second), "\n")
                                 : "\n");
  }
  // gnuplot refuses a block without a point.
  if (!any) absl::StrAppend(&script, "nan nan\n");
  absl::StrAppend(&script, "EOD\n");
}

// A point of a curve, to a pixel upwards.
struct Place {
  double x;
  int64_t pixel;
  size_t curve;
  size_t point;
  // clang-tidy 14 takes the 0 with which an ordering is compared for a pointer.
  friend auto operator<=>(const Place&, const Place&) = default;  // NOLINT(modernize-use-nullptr)
};

// Returns for each point of each curve how many later curves go through the same place: they would hide it.
std::vector<std::vector<int64_t>> CountLater(const Panel& panel, const Axes& axes) {
  std::vector<std::vector<int64_t>> later(panel.curves.size());
  std::vector<Place> places;
  for (size_t curve = 0; curve < panel.curves.size(); ++curve) {
    if (!panel.curves[curve].style.empty()) continue;
    const Points& points = panel.curves[curve].points;
    later[curve].resize(points.size());
    for (size_t i = 0; i < points.size(); ++i) {
      if (!axes.Shows(points[i])) continue;
      const double height = std::clamp(axes.Height(points[i].second), -1e9, 1e9);
      places.push_back({points[i].first, std::llround(1000.0 * height), curve, i});
    }
  }
  std::sort(places.begin(), places.end());
  for (auto first = places.begin(); first != places.end();) {
    const auto end = std::find_if(first, places.end(), [&](const Place& other) {
      return std::pair(other.x, other.pixel) != std::pair(first->x, first->pixel);
    });
    auto next = end;  // Where later curves begin.
    for (auto at = end; at != first;) {
      --at;
      if (at + 1 != end && (at + 1)->curve != at->curve) next = at + 1;
      later[at->curve][at->point] = end - next;
    }
    first = end;
  }
  return later;
}

// Returns the points that at least `least` later curves go through; NaN stands between parts of the line.
Points Hidden(const Points& points, const std::vector<int64_t>& later, int64_t least) {
  Points hidden;
  for (size_t i = 0; i < points.size(); ++i) hidden.push_back(later[i] >= least ? points[i] : std::pair(kNan, kNan));
  return hidden;
}

// Moves marks beyond the ends of the axis upwards to its ends.
Points WithinFrame(Points points, const Axes& axes) {
  for (auto& [x, y] : points) y = std::clamp(y, axes.y.lower, axes.y.upper);
  return points;
}

// Returns where the curve is beyond the upper or the lower end of the axis, at this end.
Points Beyond(const Points& points, const Axes& axes, Mark mark) {
  Points beyond;
  for (const auto& [x, y] : points) {
    if (mark == Mark::kUp ? y > axes.y.upper : y < axes.y.lower) {
      beyond.emplace_back(x, mark == Mark::kUp ? axes.y.upper : axes.y.lower);
    }
  }
  return beyond;
}

}  // namespace

std::string Quoted(const std::string& text) {
  std::vector<std::string> lines = absl::StrSplit(Printable(text), '\n');
  for (std::string& line : lines) line = absl::StrCat("'", absl::StrReplaceAll(line, {{"'", "''"}}), "'");
  return absl::StrJoin(lines, R"(."\n".)");
}

std::vector<std::string> AppendCurves(const std::string& prefix, const Panel& panel, const Axes& axes,
                                      std::string& script) {
  const std::vector<std::vector<int64_t>> later = CountLater(panel, axes);
  std::vector<std::string> parts;
  std::vector<std::string> keys;
  const auto add = [&](const std::string& name, const Points& points, const std::string& style,
                       const std::string& title) {
    AppendData(name, points, axes, script);
    parts.push_back(absl::StrCat("$", name, " using 1:2 ", style,
                                 title.empty() ? " notitle" : absl::StrCat(" title ", Quoted(title))));
  };
  const auto add_marks = [&](const std::string& name, const Points& points, const std::string& style) {
    if (!points.empty()) add(name, points, style, "");
  };
  for (size_t i = 0; i < panel.curves.size(); ++i) {
    const Curve& curve = panel.curves[i];
    const int look = curve.look >= 0 ? curve.look : static_cast<int>(i);
    const std::string name = absl::StrCat(prefix, "c", i);
    if (!curve.key_style.empty()) {
      add(name, WithinFrame(curve.points, axes), curve.style, "");
      keys.push_back(absl::StrCat("keyentry ", curve.key_style, " title ", Quoted(curve.title)));
    } else if (!curve.style.empty()) {
      add(name, curve.points, curve.style, curve.title);
    }
    if (!curve.style.empty()) continue;
    // Where `least` or more later curves cover a tenth of this one, it is drawn as a wider ribbon below them.
    for (int64_t least = kMostRibbons; least > 0; --least) {
      const auto is_hidden = [&](int64_t count) { return count >= least; };
      const int64_t hidden = std::count_if(later[i].begin(), later[i].end(), is_hidden);
      if (10 * hidden < std::max<int64_t>(20, Shown(curve.points, axes))) continue;
      add(absl::StrCat(name, "ribbon", least), Hidden(curve.points, later[i], least),
          LineStyle(look, kLineWidth + kRibbon * static_cast<double>(least)), "");
    }
    add(name, curve.points, LineStyle(look, kLineWidth), curve.title);
    add_marks(name + "points", Isolated(curve.points, axes), MarkStyle(Mark::kCircle, look));
    if (!panel.robust) continue;
    add_marks(name + "above", Beyond(curve.points, axes, Mark::kUp), MarkStyle(Mark::kUp, look));
    add_marks(name + "below", Beyond(curve.points, axes, Mark::kDown), MarkStyle(Mark::kDown, look));
  }
  if (!panel.x_missing.empty()) {
    Points crosses;
    for (const double x : panel.x_missing) crosses.emplace_back(x, axes.y.lower);
    add(prefix + "missing", crosses, "with points pointtype 2 pointsize 1.2 linewidth 2 linecolor rgb '#7F7F7F'",
        kNoValue);
  }
  parts.insert(parts.end(), keys.begin(), keys.end());
  return parts;
}

}  // namespace ricochet::cli
