#include "client/cli/sweep/sweep_plot.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "absl/strings/str_split.h"
#include "client/cli/text/label.h"
#include "client/cli/text/table.h"

namespace ricochet::cli {
namespace {

constexpr double kGap = std::numeric_limits<double>::quiet_NaN();
constexpr size_t kMostCurves = 49;
constexpr size_t kMostCells = 250'000;
// Two axes that both have more values than this are drawn as a map, unless curves are asked for.
constexpr size_t kFewValues = 12;

Label LabelIn(const SweepTable& table, const std::string& path) {
  Label label = LabelOf(path);
  const auto unit = table.units.find(path);
  if (unit != table.units.end()) label.unit = unit->second;
  return label;
}

// Returns the columns of each unit, in the order in which the units first appear.
std::vector<std::vector<size_t>> ByUnit(const SweepTable& table) {
  std::vector<std::vector<size_t>> groups;
  for (size_t column = 0; column < table.columns.size(); ++column) {
    const std::string unit = LabelIn(table, table.columns[column]).unit;
    const auto group = std::find_if(groups.begin(), groups.end(), [&](const std::vector<size_t>& others) {
      return LabelIn(table, table.columns[others.front()]).unit == unit;
    });
    if (group == groups.end()) {
      groups.push_back({column});
    } else {
      group->push_back(column);
    }
  }
  return groups;
}

// Returns the words that the symbols of all columns begin with, if each has more words.
std::string SharedWords(const SweepTable& table, const std::vector<size_t>& columns) {
  std::vector<std::string> shared;
  for (size_t i = 0; i < columns.size(); ++i) {
    std::vector<std::string> words = absl::StrSplit(LabelIn(table, table.columns[columns[i]]).symbol, ' ');
    words.pop_back();
    if (i == 0) shared = words;
    const auto ends = std::mismatch(shared.begin(), shared.end(), words.begin(), words.end());
    shared.erase(ends.first, shared.end());
  }
  return columns.size() > 1 ? absl::StrJoin(shared, " ") : "";
}

// Returns the name of the only column, else the words that all share, else the symbols of up to three or "value", with
// the unit that all share.
Label LabelOfAll(const SweepTable& table, const std::vector<size_t>& columns) {
  Label label = LabelIn(table, table.columns[columns.front()]);
  if (columns.size() == 1) return label;
  label.name = SharedWords(table, columns);
  if (!label.name.empty()) return label;
  std::vector<std::string> symbols;
  for (const size_t column : columns) symbols.push_back(LabelIn(table, table.columns[column]).symbol);
  label.name = columns.size() <= 3 ? absl::StrJoin(symbols, ", ") : "value";
  return label;
}

std::vector<double> Distinct(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  values.erase(std::unique(values.begin(), values.end()), values.end());
  return values;
}

// True for three or more values whose ratios are equal but for rounding. `values` grow.
bool AreLogSpaced(const std::vector<double>& values) {
  if (values.size() < 3 || !(values.front() > 0.0)) return false;
  const auto steps = static_cast<double>(values.size() - 1);
  const double step = (std::log(values.back()) - std::log(values.front())) / steps;
  for (size_t i = 0; i < values.size(); ++i) {
    const double expected = std::log(values.front()) + static_cast<double>(i) * step;
    if (std::abs(std::log(values[i]) - expected) > 1e-6 * step) return false;
  }
  return true;
}

// --- Curves ---

// The points that agree on all axes but the last, in the order of that axis; or all points, in the order of the table,
// where the axes advance together.
struct Group {
  std::vector<double> outer;  // Their values on those axes.
  std::vector<size_t> points;
};

std::vector<Group> GroupsOf(const SweepTable& table) {
  std::vector<Group> groups;
  std::map<std::vector<double>, size_t> known;
  std::vector<double> outer(table.axes.size() - 1);
  for (size_t i = 0; i < table.points(); ++i) {
    for (size_t axis = 0; axis < outer.size(); ++axis) outer[axis] = table.at[axis][i];
    if (groups.empty() || groups.back().outer != outer) {
      const auto [place, is_new] = known.emplace(outer, groups.size());
      if (is_new) groups.push_back({outer, {}});
      groups[place->second].points.push_back(i);
    } else {
      groups.back().points.push_back(i);
    }
  }
  // Where no two points agree, the axes advance together, and the points are one curve.
  if (groups.size() < 2 || groups.size() != table.points() || Distinct(table.at.back()).size() < 2) {
    const std::vector<double>& x = table.at.back();
    for (Group& group : groups) {
      std::stable_sort(group.points.begin(), group.points.end(), [&x](size_t a, size_t b) { return x[a] < x[b]; });
    }
    return groups;
  }
  Group all;
  for (size_t i = 0; i < table.points(); ++i) all.points.push_back(i);
  return {all};
}

std::string TitleOf(const SweepTable& table, const Group& group, size_t column, const std::vector<size_t>& columns) {
  std::vector<std::string> parts;
  if (columns.size() > 1 || group.outer.empty()) {
    const std::string symbol = LabelIn(table, table.columns[column]).symbol;
    const std::string shared = SharedWords(table, columns);
    parts.push_back(shared.empty() ? symbol : symbol.substr(shared.size() + 1));
  }
  for (size_t i = 0; i < group.outer.size(); ++i) {
    const Label label = LabelIn(table, table.axes[i]);
    const std::string unit = label.unit.empty() ? "" : absl::StrCat(" ", label.unit);
    parts.push_back(absl::StrCat(label.symbol, " = ", Rounded(group.outer[i]), unit));
  }
  return absl::StrJoin(parts, ", ");
}

// True if the group lacks points between those that it has: a file can have rows of a sweep only.
bool LacksPoints(const SweepTable& table, const Group& group) {
  if (table.index.empty()) return false;
  const auto is_before = [&table](size_t a, size_t b) { return table.index[a] < table.index[b]; };
  const auto [first, last] = std::minmax_element(group.points.begin(), group.points.end(), is_before);
  return table.index[*last] - table.index[*first] + 1.0 != static_cast<double>(group.points.size());
}

// Adds to `missing` where the curve has no value.
Curve CurveOf(const SweepTable& table, const Group& group, size_t column, std::set<double>& missing) {
  Curve curve;
  const std::vector<double>& values = table.values[column];
  const bool lacks_points = LacksPoints(table, group);
  for (size_t k = 0; k < group.points.size(); ++k) {
    const size_t i = group.points[k];
    const double x = table.at.back()[i];
    const size_t before = k > 0 ? group.points[k - 1] : i;
    const bool changes = !table.regimes.empty() && table.regimes[before] != table.regimes[i];
    const bool jumps = lacks_points && std::abs(table.index[i] - table.index[before]) > 1.0;
    if (changes || jumps) curve.points.emplace_back(kGap, kGap);
    curve.points.emplace_back(x, values[i]);
    if (!std::isfinite(values[i])) missing.insert(x);
  }
  return curve;
}

bool IsJammed(const SweepTable& table, size_t point) {
  return !table.regimes.empty() && table.regimes[point] == Regime::kLocked;
}

bool IsInadmissible(const SweepTable& table, size_t point) {
  return !table.statuses.empty() && table.statuses[point] == RowStatus::kInadmissible;
}

using Values = std::vector<double>;

struct Mark {
  const char* title;
  const char* colour;
  bool (*holds)(const SweepTable& table, size_t point);
};
constexpr Mark kJam{kJammed, kJamColour, IsJammed};
constexpr Mark kLimit{"inadmissible", "red", IsInadmissible};

// Adds marks of this shape and size at the points that have it, one for each of `ys`.
void AddMarks(const SweepTable& table, const Mark& mark, int shape, double size, const std::vector<const Values*>& ys,
              Panel& panel) {
  const auto style = [&](double pointsize) {
    return absl::StrCat("with points pointtype ", shape, " pointsize ", pointsize, " linewidth 1.5 linecolor rgb '",
                        mark.colour, "'");
  };
  Curve marks{.title = mark.title, .points = {}, .style = style(size), .key_style = style(std::max(size, 0.6))};
  for (size_t i = 0; i < table.points(); ++i) {
    if (!mark.holds(table, i)) continue;
    for (const Values* const y : ys) marks.points.emplace_back(table.at.back()[i], (*y)[i]);
  }
  if (!marks.points.empty()) panel.curves.push_back(std::move(marks));
}

// gnuplot's numbers.
constexpr int kSquare = 5;
constexpr int kRing = 6;
constexpr int kDot = 7;

Panel CurvePanel(const SweepTable& table, const std::vector<Group>& groups, const std::vector<size_t>& columns) {
  Panel panel{.title = "",
              .x_label = WithUnit(LabelIn(table, table.axes.back())),
              .y_label = WithUnit(LabelOfAll(table, columns)),
              .log_x = AreLogSpaced(Distinct(table.at.back())),
              .robust = true};
  std::vector<const Values*> ys;
  for (const size_t column : columns) ys.push_back(&table.values[column]);
  // Lines are drawn upon the marks of jammed points, and rings upon lines.
  AddMarks(table, kJam, kSquare, 1.0, ys, panel);
  std::set<double> missing;
  int look = 0;
  for (const Group& group : groups) {
    for (const size_t column : columns) {
      Curve& curve = panel.curves.emplace_back(CurveOf(table, group, column, missing));
      curve.title = TitleOf(table, group, column, columns);
      curve.look = look++;
    }
  }
  panel.x_missing.assign(missing.begin(), missing.end());
  AddMarks(table, kLimit, kRing, 0.6, ys, panel);
  return panel;
}

absl::Status TooManyCurves(const SweepTable& table) {
  return absl::FailedPreconditionError(absl::StrCat("the sweep has more than ", kMostCurves,
                                                    " curves; the last axis should be the long one",
                                                    table.axes.size() == 2 ? ", or --kind map draws cells" : ""));
}

absl::StatusOr<Plot> CurvesOf(const SweepTable& table) {
  const std::vector<Group> groups = GroupsOf(table);
  if (groups.size() * table.columns.size() > kMostCurves) return TooManyCurves(table);
  Plot plot;
  std::vector<std::string> names;
  for (const std::vector<size_t>& columns : ByUnit(table)) {
    plot.panels.push_back(CurvePanel(table, groups, columns));
    names.push_back(LabelOfAll(table, columns).name);
  }
  plot.title = absl::StrCat(absl::StrJoin(names, "; "), " over ", LabelIn(table, table.axes.back()).name);
  const bool advance_together = groups.size() == 1 && groups.front().outer.empty();
  for (size_t axis = 0; advance_together && axis + 1 < table.axes.size(); ++axis) {
    absl::StrAppend(&plot.title, axis == 0 ? ", with " : " and ", LabelIn(table, table.axes[axis]).name);
  }
  return plot;
}

// --- Maps ---

// True if jammed points have nothing to show in this column but that they jam: coefficients and velocities are 0.
bool JamIsZero(const SweepTable& table, const Values& values) {
  for (size_t i = 0; i < table.points(); ++i) {
    if (IsJammed(table, i) && values[i] != 0.0) return false;
  }
  return true;
}

absl::StatusOr<Plot> MapsOf(const SweepTable& table, const std::vector<double>& xs, const std::vector<double>& ys) {
  const size_t cells = table.points() * table.columns.size();
  if (cells > kMostCells) {
    return absl::FailedPreconditionError(absl::StrCat(cells, " cells are more than a map can show: must be at most ",
                                                      kMostCells,
                                                      ", such as 500 x 500; a sweep with fewer values shows the same"));
  }
  const Label x = LabelIn(table, table.axes[1]);
  const Label y = LabelIn(table, table.axes[0]);
  // Dots fit into cells.
  const double dot = std::clamp(8.0 / static_cast<double>(std::max(xs.size(), ys.size())), 0.2, 0.5);
  Plot plot;
  std::vector<std::string> names;
  for (size_t column = 0; column < table.columns.size(); ++column) {
    const Label label = LabelIn(table, table.columns[column]);
    Panel panel{.title = "",
                .x_label = WithUnit(x),
                .y_label = WithUnit(y),
                .log_x = AreLogSpaced(xs),
                .log_y = AreLogSpaced(ys)};
    panel.map_label = WithUnit(label);
    const Values& values = table.values[column];
    const bool is_plain = JamIsZero(table, values);
    for (size_t i = 0; i < table.points(); ++i) {
      panel.map.push_back({table.at[1][i], table.at[0][i], values[i], is_plain && IsJammed(table, i)});
    }
    if (!is_plain) AddMarks(table, kJam, kDot, dot, {&table.at[0]}, panel);
    AddMarks(table, kLimit, kDot, dot, {&table.at[0]}, panel);
    plot.panels.push_back(std::move(panel));
    names.push_back(label.name);
  }
  plot.title = absl::StrCat(absl::StrJoin(names, "; "), " over ", x.name, " and ", y.name);
  return plot;
}

// Files can have values that no sweep has.
absl::Status CheckAxes(const SweepTable& table) {
  for (size_t axis = 0; axis < table.axes.size(); ++axis) {
    const Values& at = table.at[axis];
    const auto wrong = std::find_if(at.begin(), at.end(), [](double value) { return !std::isfinite(value); });
    if (wrong == at.end()) continue;
    return absl::InvalidArgumentError(absl::StrCat(table.axes[axis], " = ", *wrong, " at point ", wrong - at.begin(),
                                                   ": must be finite to be drawn"));
  }
  return absl::OkStatus();
}

}  // namespace

absl::StatusOr<Plot> PlotOf(const SweepTable& table, PlotKind kind) {
  if (table.axes.empty()) return absl::FailedPreconditionError("a sweep without an axis cannot be drawn");
  if (absl::Status finite = CheckAxes(table); !finite.ok()) return finite;
  if (kind != PlotKind::kCurves && table.axes.size() == 2) {
    const std::vector<double> xs = Distinct(table.at[1]);
    const std::vector<double> ys = Distinct(table.at[0]);
    const bool is_whole = table.points() == xs.size() * ys.size();
    const bool is_large = xs.size() > kFewValues && ys.size() > kFewValues;
    if (kind == PlotKind::kAuto && is_whole && is_large) return MapsOf(table, xs, ys);
    if (kind == PlotKind::kMap && table.points() > std::max(xs.size(), ys.size())) return MapsOf(table, xs, ys);
  }
  if (kind == PlotKind::kMap) {
    return absl::InvalidArgumentError("--kind map needs a grid of two axes that are combined with each other");
  }
  return CurvesOf(table);
}

SweepPlot::SweepPlot(const SweepRequest& request, PlotKind kind) : grid_(request.grid), cursor_(grid_), kind_(kind) {
  for (const Axis& axis : grid_.axes) table_.axes.push_back(axis.path);
  table_.columns = request.columns;
  table_.at.resize(table_.axes.size());
  table_.values.resize(table_.columns.size());
}

SweepRequest SweepPlot::Wanted(SweepRequest request) {
  request.with_regime = true;
  return request;
}

void SweepPlot::Add(const SweepChunk& chunk) {
  if (status_.ok() && table_.columns.size() > kMostCurves) status_ = TooManyCurves(table_);
  if (status_.ok() && chunk.points_total > SweepTable::kMostPoints) {
    status_ = absl::FailedPreconditionError(
        absl::StrCat(chunk.points_total, " points are more than a picture can show (", SweepTable::kMostPoints, ")"));
  }
  if (!status_.ok()) return;
  for (int64_t i = 0; i < chunk.count; ++i) {
    const std::vector<double>& at = cursor_.At(chunk.first_index + i);
    for (size_t axis = 0; axis < at.size(); ++axis) table_.at[axis].push_back(at[axis]);
  }
  const auto count = static_cast<std::ptrdiff_t>(chunk.count);
  for (size_t column = 0; column < table_.values.size(); ++column) {
    const auto first = chunk.values.begin() + static_cast<std::ptrdiff_t>(column) * count;
    table_.values[column].insert(table_.values[column].end(), first, first + count);
  }
  table_.regimes.insert(table_.regimes.end(), chunk.regimes.begin(), chunk.regimes.end());
  table_.statuses.insert(table_.statuses.end(), chunk.statuses.begin(), chunk.statuses.end());
}

absl::StatusOr<Plot> SweepPlot::Make() const { return status_.ok() ? PlotOf(table_, kind_) : status_; }

}  // namespace ricochet::cli
