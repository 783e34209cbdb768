#include "client/cli/report/audit_plot.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "absl/strings/str_cat.h"

namespace ricochet::cli {
namespace {

// A verdict on a row, and the mark of its rows.
struct Kind {
  const char* title;
  const char* style;
};

constexpr std::array kKinds = {
    Kind{"admissible", "with points pointtype 7 pointsize 0.8 linecolor rgb '#0072B2'"},
    Kind{"within uncertainty", "with points pointtype 6 pointsize 1 linewidth 1.5 linecolor rgb '#E69F00'"},
    Kind{"inadmissible", "with points pointtype 2 pointsize 1 linewidth 2 linecolor rgb 'red'"},
    Kind{"unexplained", "with points pointtype 8 pointsize 1 linewidth 1.5 linecolor rgb '#7F7F7F'"}};

size_t KindOf(const AuditReport& report) {
  if (report.unexplained) return 3;
  if (!report.admissible) return 2;
  const bool at_edge = std::any_of(report.limits.begin(), report.limits.end(), [](const LimitCheck& check) {
    return check.verdict == Verdict::kWithinUncertainty;
  });
  return at_edge ? 1 : 0;
}

// Returns p_t in a plane, and its magnitude in space.
double TangentialImpulse(const AuditReport& report) {
  const auto [first, second] = report.tangential_impulse;
  return second == 0.0 ? first : std::hypot(first, second);
}

// Returns one curve for each verdict that a row has, of the points that `place` gives.
template <typename Place>
std::vector<Curve> CurvesOf(const std::vector<AuditReport>& reports, Place place) {
  std::array<Curve, kKinds.size()> all;
  for (size_t row = 0; row < reports.size(); ++row) {
    if (reports[row].regime == Regime::kInvalid) continue;
    all[KindOf(reports[row])].points.push_back(place(row, reports[row]));
  }
  std::vector<Curve> curves;
  for (size_t kind = 0; kind < kKinds.size(); ++kind) {
    all[kind].title = kKinds[kind].title;
    all[kind].style = kKinds[kind].style;
    if (!all[kind].points.empty()) curves.push_back(std::move(all[kind]));
  }
  return curves;
}

// Adds the friction cone of the row with the most friction; the legend says if other rows have narrower ones.
void AddCone(const std::vector<AuditReport>& reports, Panel& panel) {
  double friction = 0.0, least_friction = std::numeric_limits<double>::infinity();
  double reach = 0.0;
  for (const AuditReport& report : reports) {
    if (report.regime == Regime::kInvalid || !(report.normal_impulse > 0.0)) continue;
    const double of_row = report[AuditLimit::kCone].limit / report.normal_impulse;
    friction = std::max(friction, of_row);
    least_friction = std::min(least_friction, of_row);
    reach = std::max(reach, report.normal_impulse);
  }
  const bool is_of_all = friction <= least_friction * (1.0 + 1e-9);
  panel.curves.push_back({.title = is_of_all ? "friction cone" : "the widest row's friction cone",
                          .points = {{reach, -friction * reach}, {0.0, 0.0}, {reach, friction * reach}},
                          .style = "with lines linewidth 1.5 dashtype 2 linecolor rgb '#606060'"});
}

// The panel of one number over the rows, with its limit.
Panel RowPanel(const std::vector<AuditReport>& reports, const char* title, const char* y_label, double limit,
               double AuditReport::*number) {
  Panel panel{.title = title, .x_label = "row", .y_label = y_label, .whole_x = true, .y_marks = {limit}};
  panel.curves = CurvesOf(reports, [number](size_t row, const AuditReport& report) {
    return std::pair(static_cast<double>(row), report.*number);
  });
  for (size_t row = 0; row < reports.size(); ++row) {
    if (reports[row].regime == Regime::kInvalid) panel.x_missing.push_back(static_cast<double>(row));
  }
  return panel;
}

}  // namespace

void AuditPlot::Add(const AuditReport& report) {
  ++rows_;
  if (reports_.size() < kMostRows) reports_.push_back(report);
}

absl::StatusOr<Plot> AuditPlot::Make() const {
  if (rows_ > kMostRows) {
    return absl::FailedPreconditionError(
        absl::StrCat(rows_, " rows are more than a picture can show (", kMostRows, ")"));
  }
  Panel impulse{.title = "Impulse", .x_label = "normal impulse [N s]", .y_label = "tangential impulse [N s]"};
  impulse.curves = CurvesOf(
      reports_, [](size_t, const AuditReport& r) { return std::pair(r.normal_impulse, TangentialImpulse(r)); });
  if (impulse.curves.empty()) return absl::FailedPreconditionError("no row has numbers to draw");
  AddCone(reports_, impulse);
  return Plot{
      .title = "Audited impacts (dashed: the limits)",
      .panels = {std::move(impulse),
                 RowPanel(reports_, "Energetic coefficient", "energetic coefficient", 1.0, &AuditReport::energetic),
                 RowPanel(reports_, "Change of kinetic energy", "E+ - E- [J]", 0.0, &AuditReport::energy_change)}};
}

}  // namespace ricochet::cli
