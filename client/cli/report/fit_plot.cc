#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "client/cli/report/fit_report.h"
#include "client/cli/text/label.h"
#include "client/cli/text/table.h"

namespace ricochet::cli {
namespace {

constexpr char kData[] = "with points pointtype 7 pointsize 0.9 linecolor rgb '#0072B2'";
constexpr char kModel[] = "with points pointtype 6 pointsize 1.3 linewidth 1.5 linecolor rgb '#D55E00'";
constexpr char kProfile[] = "with linespoints pointtype 7 pointsize 0.5 linewidth 1.5 linecolor rgb '#0072B2'";
constexpr char kBest[] = "with points pointtype 1 pointsize 1.5 linewidth 2 linecolor rgb '#404040'";
// The panel of a profile leaves out rises above this.
constexpr double kMostRise = 12.0;
// Residuals beyond these are rare.
constexpr double kRare = 2.0;

// The horizontal axis: an input that differs by row, or the number of the row.
struct Abscissa {
  std::string label = "row";
  const std::vector<double>* values = nullptr;

  double At(size_t row) const { return values == nullptr ? static_cast<double>(row) : (*values)[row]; }
};

Abscissa AbscissaOf(const FitRequest& request) {
  for (const FitInput& input : request.inputs) {
    if (std::adjacent_find(input.values.begin(), input.values.end(), std::not_equal_to<>()) == input.values.end()) {
      continue;
    }
    return {.label = WithUnit(LabelOf(input.path)), .values = &input.values};
  }
  return {};
}

Panel DataPanel(const FitRequest& request, const FitResponse& response, const Abscissa& x, size_t column) {
  const FitMeasured& measured = request.measured[column];
  const Label label = LabelOf(measured.path);
  Panel panel{.title = label.name, .x_label = x.label, .y_label = WithUnit(label), .whole_x = x.values == nullptr};
  Curve data{.title = "measured", .points = {}, .style = kData};
  Curve model{.title = "fitted", .points = {}, .style = kModel};
  for (size_t row = 0; row < response.rows.size(); ++row) {
    if (std::isnan(measured.values[row])) continue;
    data.points.emplace_back(x.At(row), measured.values[row]);
    model.points.emplace_back(x.At(row), response.rows[row].predicted[column]);
  }
  panel.curves = {std::move(data), std::move(model)};
  return panel;
}

Panel ResidualPanel(const FitRequest& request, const FitResponse& response, const Abscissa& x) {
  constexpr std::array kColours = {"#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9"};
  Panel panel{.title = "Residuals (dashed: 2 sigma)",
              .x_label = x.label,
              .y_label = "(measured - fitted)/sigma",
              .whole_x = x.values == nullptr,
              .y_marks = {-kRare, 0.0, kRare}};
  for (size_t column = 0; column < request.measured.size(); ++column) {
    Curve curve{.title = LabelOf(request.measured[column].path).name, .points = {}};
    curve.style = absl::StrCat("with points pointtype ", 5 + column % kColours.size(), " pointsize 0.9 linecolor rgb '",
                               kColours[column % kColours.size()], "'");
    for (size_t row = 0; row < response.rows.size(); ++row) {
      const double residual = response.rows[row].residuals[column];
      if (!std::isnan(residual)) curve.points.emplace_back(x.At(row), residual);
    }
    panel.curves.push_back(std::move(curve));
  }
  return panel;
}

Panel ProfilePanel(const FitEstimate& unknown, double interval_rise) {
  const Label label = LabelOf(unknown.path);
  Panel panel{.title = absl::StrCat("Profile of ", label.name, unknown.seen ? "" : " (not seen)"),
              .x_label = WithUnit(label),
              .y_label = "rise of the objective",
              .y_marks = {interval_rise}};
  Curve curve{.title = "", .points = {}, .style = kProfile};
  for (const FitProfilePoint& point : unknown.profile) {
    if (point.rise <= kMostRise) curve.points.emplace_back(point.value, point.rise);
  }
  panel.curves = {std::move(curve)};
  for (const FitEnd& end : {unknown.low, unknown.high}) {
    if (end.value.has_value()) panel.x_marks.push_back(*end.value);
  }
  return panel;
}

Panel RegionPanel(const FitRequest& request, const FitResponse& response) {
  Panel panel{.title = "95 % region",
              .x_label = WithUnit(LabelOf(request.region[0])),
              .y_label = WithUnit(LabelOf(request.region[1]))};
  Curve border{.title = "", .points = {}, .style = kProfile};
  for (const FitRegionPoint& point : response.region) border.points.emplace_back(point.x, point.y);
  if (!border.points.empty()) border.points.push_back(border.points.front());
  Curve best{.title = "best fit", .points = {}, .style = kBest};
  std::array<double, 2> at = {};
  for (const FitEstimate& unknown : response.unknowns) {
    for (size_t i = 0; i < 2; ++i) {
      if (unknown.path == request.region[i]) at[i] = unknown.value;
    }
  }
  best.points.emplace_back(at[0], at[1]);
  panel.curves = {std::move(border), std::move(best)};
  return panel;
}

}  // namespace

Plot FitPlot(const FitRequest& request, const FitResponse& response) {
  Plot plot{.title = absl::StrCat(response.refused ? "REFUSED fit" : "Fit", ", chi2 ", Rounded(response.chi2), " with ",
                                  response.degrees_of_freedom, " degrees of freedom (dashed: 95 % intervals)")};
  const Abscissa x = AbscissaOf(request);
  for (size_t column = 0; column < request.measured.size(); ++column) {
    plot.panels.push_back(DataPanel(request, response, x, column));
  }
  plot.panels.push_back(ResidualPanel(request, response, x));
  for (const FitEstimate& unknown : response.unknowns) {
    plot.panels.push_back(ProfilePanel(unknown, response.interval_rise));
  }
  if (!request.region.empty()) plot.panels.push_back(RegionPanel(request, response));
  return plot;
}

}  // namespace ricochet::cli
