#include "client/cli/sweep_plot.h"

#include <variant>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "absl/types/span.h"
#include "client/cli/label.h"
#include "client/cli/table.h"
#include "core/sweep/grid.h"

namespace ricochet::cli {
namespace {

std::string JoinedNames(const std::vector<std::string>& columns) {
  std::vector<std::string> names;
  for (const std::string& column : columns) names.push_back(LabelOf(column).symbol);
  return absl::StrJoin(names, ", ");
}

// Returns the unit that all columns share, in brackets, or an empty text if they share none.
std::string SharedUnit(const std::vector<std::string>& columns) {
  const std::string unit = LabelOf(columns.front()).unit;
  for (const std::string& column : columns) {
    if (LabelOf(column).unit != unit) return "";
  }
  return unit.empty() ? "" : absl::StrCat(" [", unit, "]");
}

std::string YLabel(const std::vector<std::string>& columns) {
  if (columns.size() == 1) return WithUnit(LabelOf(columns[0]));
  return absl::StrCat(columns.size() <= 3 ? JoinedNames(columns) : "value", SharedUnit(columns));
}

}  // namespace

absl::Status SweepPlot::Add(const SweepChunk& chunk) {
  const std::vector<Axis>& axes = request_.grid.axes;
  if (axes.empty()) return absl::FailedPreconditionError("--plot: a sweep without an axis cannot be drawn");
  if (chunk.points_total > kMostPoints) {
    return absl::FailedPreconditionError(
        absl::StrCat("--plot: ", chunk.points_total, " points are more than a picture can show (", kMostPoints, ")"));
  }
  std::vector<int64_t> positions(axes.size());
  for (int64_t i = 0; i < chunk.count; ++i) {
    AxisPositions(request_.grid, chunk.first_index + i, absl::MakeSpan(positions));
    const double x = AxisValue(axes.back(), positions.back());
    Line line{.outer = {}, .column = 0};
    if (request_.grid.combination != Combination::kZip) line.outer.assign(positions.begin(), positions.end() - 1);
    for (; line.column < request_.columns.size(); ++line.column) {
      const size_t at = line.column * static_cast<size_t>(chunk.count) + static_cast<size_t>(i);
      lines_[line].emplace_back(x, chunk.values[at]);
    }
    if (lines_.size() > kMostCurves) {
      return absl::FailedPreconditionError(
          absl::StrCat("--plot: more than ", kMostCurves, " curves; the last axis should be the long one"));
    }
  }
  return absl::OkStatus();
}

std::string SweepPlot::Title(const Line& line) const {
  std::vector<std::string> parts;
  if (request_.columns.size() > 1 || line.outer.empty()) {
    parts.push_back(LabelOf(request_.columns[line.column]).symbol);
  }
  for (size_t i = 0; i < line.outer.size(); ++i) {
    const Axis& axis = request_.grid.axes[i];
    const Label label = LabelOf(axis.path);
    const std::string unit = label.unit.empty() ? "" : absl::StrCat(" ", label.unit);
    parts.push_back(absl::StrCat(label.symbol, " = ", Rounded(AxisValue(axis, line.outer[i])), unit));
  }
  return absl::StrJoin(parts, ", ");
}

Plot SweepPlot::Make() const {
  const Axis& last = request_.grid.axes.back();
  const std::string y_label = YLabel(request_.columns);
  Panel panel{.title = "",
              .x_label = WithUnit(LabelOf(last.path)),
              .y_label = y_label,
              .log_x = std::holds_alternative<Logspace>(last.values),
              .x_marks = {},
              .curves = {}};
  for (const auto& [line, points] : lines_) panel.curves.push_back({.title = Title(line), .points = points});
  return {.title = absl::StrCat(y_label, " over ", LabelOf(last.path).name), .panels = {std::move(panel)}};
}

}  // namespace ricochet::cli
