#include "client/cli/sweep_plot.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <variant>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "absl/types/span.h"
#include "client/cli/label.h"
#include "client/cli/table.h"
#include "core/sweep/grid.h"

namespace ricochet::cli {
namespace {

constexpr double kGap = std::numeric_limits<double>::quiet_NaN();

// Returns the columns of each unit, in the order in which the units first appear.
std::vector<std::vector<size_t>> ByUnit(const std::vector<std::string>& columns) {
  std::vector<std::vector<size_t>> groups;
  for (size_t column = 0; column < columns.size(); ++column) {
    const std::string unit = LabelOf(columns[column]).unit;
    const auto group = std::find_if(groups.begin(), groups.end(), [&](const std::vector<size_t>& others) {
      return LabelOf(columns[others.front()]).unit == unit;
    });
    if (group == groups.end()) {
      groups.push_back({column});
    } else {
      group->push_back(column);
    }
  }
  return groups;
}

// Returns the name of the only column, else the symbols of up to three or "value", with the unit that all share.
Label LabelOfAll(const std::vector<size_t>& columns, const std::vector<std::string>& names) {
  Label label = LabelOf(names[columns.front()]);
  if (columns.size() == 1) return label;
  std::vector<std::string> symbols;
  for (const size_t column : columns) symbols.push_back(LabelOf(names[column]).symbol);
  label.name = columns.size() <= 3 ? absl::StrJoin(symbols, ", ") : "value";
  return label;
}

}  // namespace

SweepRequest SweepPlot::Wanted(SweepRequest request) {
  request.with_regime = true;
  return request;
}

absl::Status SweepPlot::Check(const SweepChunk& chunk) const {
  if (request_.grid.axes.empty()) return absl::FailedPreconditionError("a sweep without an axis cannot be drawn");
  if (chunk.points_total > kMostPoints) {
    return absl::FailedPreconditionError(
        absl::StrCat(chunk.points_total, " points are more than a picture can show (", kMostPoints, ")"));
  }
  if (lines_.size() > kMostCurves) {
    return absl::FailedPreconditionError(
        absl::StrCat("the sweep has more than ", kMostCurves, " curves; the last axis should be the long one"));
  }
  return absl::OkStatus();
}

void SweepPlot::Add(const SweepChunk& chunk) {
  if (status_.ok()) status_ = Check(chunk);
  const std::vector<Axis>& axes = request_.grid.axes;
  std::vector<int64_t> positions(axes.size());
  for (int64_t i = 0; status_.ok() && i < chunk.count; ++i) {
    AxisPositions(request_.grid, chunk.first_index + i, absl::MakeSpan(positions));
    const double x = AxisValue(axes.back(), positions.back());
    const Regime regime = chunk.regimes.at(static_cast<size_t>(i));
    Line line{.outer = {}, .column = 0};
    if (request_.grid.combination != Combination::kZip) line.outer.assign(positions.begin(), positions.end() - 1);
    for (; line.column < request_.columns.size(); ++line.column) {
      const double y = chunk.values[line.column * static_cast<size_t>(chunk.count) + static_cast<size_t>(i)];
      Points& points = lines_[line];
      if (!points.all.empty() && points.regime != regime) points.all.emplace_back(kGap, kGap);
      points.all.emplace_back(x, y);
      points.regime = regime;
      if (!std::isfinite(y)) points.missing.push_back(x);
    }
    if (lines_.size() > kMostCurves) status_ = Check(chunk);
  }
}

std::string SweepPlot::Title(const Line& line, size_t columns_in_panel) const {
  std::vector<std::string> parts;
  if (columns_in_panel > 1 || line.outer.empty()) parts.push_back(LabelOf(request_.columns[line.column]).symbol);
  for (size_t i = 0; i < line.outer.size(); ++i) {
    const Axis& axis = request_.grid.axes[i];
    const Label label = LabelOf(axis.path);
    const std::string unit = label.unit.empty() ? "" : absl::StrCat(" ", label.unit);
    parts.push_back(absl::StrCat(label.symbol, " = ", Rounded(AxisValue(axis, line.outer[i])), unit));
  }
  return absl::StrJoin(parts, ", ");
}

Panel SweepPlot::PanelOf(const std::vector<size_t>& columns) const {
  const Axis& last = request_.grid.axes.back();
  Panel panel{.title = "",
              .x_label = WithUnit(LabelOf(last.path)),
              .y_label = WithUnit(LabelOfAll(columns, request_.columns)),
              .log_x = std::holds_alternative<Logspace>(last.values)};
  std::set<double> missing;
  for (const auto& [line, points] : lines_) {
    if (std::find(columns.begin(), columns.end(), line.column) == columns.end()) continue;
    panel.curves.push_back({.title = Title(line, columns.size()), .points = points.all});
    missing.insert(points.missing.begin(), points.missing.end());
  }
  panel.x_missing.assign(missing.begin(), missing.end());
  return panel;
}

absl::StatusOr<Plot> SweepPlot::Make() const {
  if (!status_.ok()) return status_;
  Plot plot;
  std::vector<std::string> names;
  for (const std::vector<size_t>& columns : ByUnit(request_.columns)) {
    plot.panels.push_back(PanelOf(columns));
    names.push_back(LabelOfAll(columns, request_.columns).name);
  }
  plot.title = absl::StrCat(absl::StrJoin(names, "; "), " over ", LabelOf(request_.grid.axes.back().path).name);
  return plot;
}

}  // namespace ricochet::cli
