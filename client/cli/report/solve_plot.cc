#include "client/cli/report/solve_plot.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "client/cli/text/enum_names.h"
#include "client/cli/text/table.h"
#include "core/base/try.h"

namespace ricochet::cli {
namespace {

constexpr char kImpulse[] = "normal impulse τ [N s]";
constexpr char kRestStyle[] = "with points pointtype 1 pointsize 1.5 linewidth 2 linecolor rgb '#404040'";
constexpr char kStartStyle[] = "with points pointtype 7 pointsize 1.2 linecolor rgb '#404040'";
constexpr char kEventStyle[] = "with points pointtype 6 pointsize 1.2 linewidth 2 linecolor rgb '#404040'";
// This style joins events between which the path is not straight; the colour is appended.
constexpr char kJoin[] = "with linespoints dashtype 3 pointtype 7 pointsize 0.8 linewidth 1.5 linecolor rgb ";

// --- Over the normal impulse, in a plane ---

// Between two events of a linear path the forces have a constant ratio.
Panel RatioPanel(const std::vector<Event>& timeline) {
  Panel panel{.title = "Friction force to normal force", .x_label = kImpulse, .y_label = "F/N"};
  Curve ratio;
  for (size_t i = 1; i < timeline.size(); ++i) {
    const State& before = timeline[i - 1].state;
    const State& after = timeline[i].state;
    const double step = after.normal_impulse_n_s - before.normal_impulse_n_s;
    if (!(step > 0.0)) continue;
    const double f = after.tangential_impulse_n_s.at(0);
    const double force = (f - before.tangential_impulse_n_s.at(0)) / step;
    ratio.points.emplace_back(before.normal_impulse_n_s, force);
    ratio.points.emplace_back(after.normal_impulse_n_s, force);
    // The impulses are rounded to doubles before they are subtracted.
    panel.y_noise = std::max(panel.y_noise, 8.0 * std::numeric_limits<double>::epsilon() *
                                                (std::abs(f) + std::abs(force) * after.normal_impulse_n_s) / step);
  }
  panel.curves.push_back(std::move(ratio));
  return panel;
}

// Returns the curve of `value` over tau.
template <typename Value>
Curve OverImpulse(const std::vector<Event>& timeline, const std::string& title, Value value) {
  Curve curve{.title = title};
  for (const Event& event : timeline) curve.points.emplace_back(event.state.normal_impulse_n_s, value(event.state));
  return curve;
}

Panel RatesPanel(const std::vector<Event>& timeline) {
  const size_t links = timeline.front().state.rates_rad_s.size();
  Panel panel{.title = links == 1 ? "Angular velocity ω(τ)" : "Angular velocities ω(τ)",
              .x_label = kImpulse,
              .y_label = "ω [rad/s]"};
  for (size_t i = 0; i < links; ++i) {
    panel.curves.push_back(OverImpulse(timeline, links == 1 ? "" : absl::StrCat("link ", i + 1),
                                       [i](const State& state) { return state.rates_rad_s.at(i); }));
  }
  return panel;
}

Panel VelocityPanel(const std::vector<Event>& timeline) {
  Panel panel{.title = "Velocity of the contact", .x_label = kImpulse, .y_label = "velocity [m/s]"};
  const size_t directions = timeline.front().state.contact_velocity.tangential_m_s.size();
  for (size_t i = 0; i < directions; ++i) {
    panel.curves.push_back(
        OverImpulse(timeline, directions == 1 ? "u tangential" : absl::StrCat("u", i + 1, " tangential"),
                    [i](const State& state) { return state.contact_velocity.tangential_m_s.at(i); }));
  }
  panel.curves.push_back(
      OverImpulse(timeline, "v normal", [](const State& state) { return state.contact_velocity.normal_m_s; }));
  return panel;
}

Panel ImpulsePanel(const std::vector<Event>& timeline) {
  Panel panel{.title = "Friction impulse f(τ)", .x_label = kImpulse, .y_label = "f [N s]"};
  const size_t directions = timeline.front().state.tangential_impulse_n_s.size();
  for (size_t i = 0; i < directions; ++i) {
    panel.curves.push_back(OverImpulse(timeline, directions == 1 ? "" : absl::StrCat("f", i + 1),
                                       [i](const State& state) { return state.tangential_impulse_n_s.at(i); }));
  }
  return panel;
}

void MarkCompression(const Outcome& outcome, Panel& panel) {
  if (outcome.impulse.normal_compression_n_s.has_value()) {
    panel.x_marks.push_back(*outcome.impulse.normal_compression_n_s);
  }
}

std::string Heading(const Outcome& outcome) {
  return absl::StrCat(outcome.admissible ? "Impact: " : "INADMISSIBLE impact: ", RegimeText(outcome.regime));
}

// Explains the line that MarkCompression draws, and the dots of a path that is not straight between its events.
std::string Legend(const Outcome& outcome, bool is_straight) {
  std::vector<std::string> marks;
  if (!is_straight) marks.emplace_back("dots: events, between which the path is curved");
  if (outcome.impulse.normal_compression_n_s.has_value()) marks.emplace_back("dashed: compression ends");
  return marks.empty() ? "" : absl::StrCat(" (", absl::StrJoin(marks, "; "), ")");
}

Plot PlanarPlot(const Outcome& outcome) {
  const std::vector<Event>& timeline = outcome.timeline;
  const bool has_rates = !timeline.front().state.rates_rad_s.empty();
  const bool is_straight = IsLinearBetweenEvents(outcome.plan.model);
  Plot plot{.title = absl::StrCat(Heading(outcome), Legend(outcome, is_straight))};
  plot.panels = {has_rates ? RatesPanel(timeline) : VelocityPanel(timeline), RatioPanel(timeline),
                 ImpulsePanel(timeline)};
  for (Panel& panel : plot.panels) {
    MarkCompression(outcome, panel);
    if (is_straight) continue;
    for (size_t i = 0; i < panel.curves.size(); ++i) {
      panel.curves[i].style = absl::StrCat(kJoin, i == 0 ? "'#0072B2'" : "'#D55E00'");
    }
  }
  if (!is_straight) plot.panels[1].title = "Mean friction force to normal force";
  return plot;
}

// --- Over time ---

template <typename Value>
Curve OverTime(const std::vector<ForceSample>& history, const std::string& title, Value value) {
  Curve curve{.title = title};
  for (const ForceSample& sample : history) curve.points.emplace_back(sample.time_s, value(sample));
  return curve;
}

// Returns the loop with a mark at the first touch; time runs up its left branch in compression and down in restitution.
Panel LoopPanel(const std::vector<ForceSample>& history) {
  Panel panel{.title = "Normal force over indentation", .x_label = "indentation d [m]", .y_label = "N [N]"};
  Curve compression{.title = "compression"};
  Curve restitution{.title = "restitution"};
  const auto deepest = std::max_element(history.begin(), history.end(), [](const ForceSample& a, const ForceSample& b) {
    return a.indentation_m < b.indentation_m;
  });
  for (auto sample = history.begin(); sample != history.end(); ++sample) {
    if (sample <= deepest) compression.points.emplace_back(sample->indentation_m, sample->normal_n);
    if (sample >= deepest) restitution.points.emplace_back(sample->indentation_m, sample->normal_n);
  }
  panel.curves = {std::move(compression), std::move(restitution)};
  return panel;
}

Plot DurationPlot(const Outcome& outcome) {
  constexpr char kTime[] = "time t [s]";
  const std::vector<ForceSample>& history = outcome.contact->history;
  Panel forces{.title = "Forces", .x_label = kTime, .y_label = "force [N]"};
  forces.curves = {OverTime(history, "N normal", [](const ForceSample& s) { return s.normal_n; }),
                   OverTime(history, "F tangential", [](const ForceSample& s) { return s.tangential_n; })};
  Panel depth{.title = "Indentation", .x_label = kTime, .y_label = "d [m]"};
  depth.curves = {OverTime(history, "", [](const ForceSample& s) { return s.indentation_m; })};
  Panel velocity{.title = "Velocity of the contact", .x_label = kTime, .y_label = "velocity [m/s]"};
  velocity.curves = {OverTime(history, "u tangential", [](const ForceSample& s) { return s.tangential_m_s; }),
                     OverTime(history, "v normal", [](const ForceSample& s) { return s.normal_m_s; })};
  return {.title = absl::StrCat(Heading(outcome), ", ", Rounded(outcome.contact->duration_s), " s long"),
          .panels = {std::move(forces), std::move(depth), std::move(velocity), LoopPanel(history)}};
}

// --- In space ---

// Returns the events of the path, and the states between them that audits of the scene find.
absl::StatusOr<std::vector<Event>> SpatialPath(const Solver& solver, const Scene& scene, const Outcome& outcome) {
  RICOCHET_TRY(const AuditBatchResponse parts,
               solver.AuditBatch({.scene = scene, .columns = PartsOfTheWay(outcome, kPlotIntervals)}));
  std::vector<Event> path = outcome.timeline;
  for (const AuditReport& report : parts.reports) {
    if (report.regime == Regime::kInvalid || report.unexplained) continue;
    State& state = path.emplace_back().state;
    state.normal_impulse_n_s = report.normal_impulse;
    for (size_t i = 0; i < 2; ++i) {
      state.tangential_impulse_n_s.push_back(report.tangential_impulse[i] - report.friction_mismatch[i]);
      state.contact_velocity.tangential_m_s.push_back(report.path_tangential_velocity[i]);
    }
    state.contact_velocity.normal_m_s = report.path_normal_velocity;
  }
  std::stable_sort(path.begin(), path.end(), [](const Event& a, const Event& b) {
    return a.state.normal_impulse_n_s < b.state.normal_impulse_n_s;
  });
  return path;
}

Panel HodographPanel(const std::vector<Event>& path) {
  Panel panel{.title = "Slip hodograph", .x_label = "slip u1 [m/s]", .y_label = "slip u2 [m/s]", .equal_scales = true};
  Curve slip;
  Curve rest{.title = "no slip", .points = {{0.0, 0.0}}, .style = kRestStyle};
  Curve start{.title = "contact starts", .points = {}, .style = kStartStyle};
  Curve events{.title = "later events", .points = {}, .style = kEventStyle};
  for (const Event& event : path) {
    const Components& u = event.state.contact_velocity.tangential_m_s;
    slip.points.emplace_back(u.at(0), u.at(1));
    if (event.kind == EventKind::kUnspecified) continue;
    (event.kind == EventKind::kStart ? start : events).points.emplace_back(u.at(0), u.at(1));
  }
  panel.curves = {std::move(slip), std::move(rest), std::move(start), std::move(events)};
  return panel;
}

absl::StatusOr<Plot> SpatialPlot(const Solver& solver, const Scene& scene, const Outcome& outcome) {
  RICOCHET_TRY(const std::vector<Event> path, SpatialPath(solver, scene, outcome));
  Panel velocity = VelocityPanel(path);
  Panel impulse = ImpulsePanel(path);
  MarkCompression(outcome, velocity);
  MarkCompression(outcome, impulse);
  return Plot{.title = absl::StrCat(Heading(outcome), Legend(outcome, true)),
              .panels = {HodographPanel(path), std::move(velocity), std::move(impulse)}};
}

}  // namespace

AuditColumns PartsOfTheWay(const Outcome& outcome, int intervals) {
  const ContactVelocity& from = outcome.timeline.front().state.contact_velocity;
  const ContactVelocity& to = outcome.timeline.back().state.contact_velocity;
  AuditColumns columns;
  for (int i = 0; i <= intervals; ++i) {
    const double part = static_cast<double>(i) / intervals;
    const auto between = [part](double a, double b) { return a + part * (b - a); };
    columns.tangential_after_m_s.push_back(between(from.tangential_m_s[0], to.tangential_m_s[0]));
    columns.tangential_2_after_m_s.push_back(between(from.tangential_m_s[1], to.tangential_m_s[1]));
    columns.normal_after_m_s.push_back(between(from.normal_m_s, to.normal_m_s));
  }
  return columns;
}

absl::StatusOr<Plot> SolvePlot(const Solver& solver, const SolveRequest& request, const SolveResponse& response) {
  const Outcome& outcome = response.outcome;
  if (outcome.timeline.size() < 2) {
    return absl::FailedPreconditionError("the contact separates or follows a law without a course: nothing to draw");
  }
  if (TangentialDirections(request.scene.system) == 2) return SpatialPlot(solver, request.scene, outcome);
  if (!outcome.contact.has_value()) return PlanarPlot(outcome);
  if (!outcome.contact->history.empty()) return DurationPlot(outcome);
  SolveRequest more = request;
  more.force_intervals = kPlotIntervals;
  more.certified_digits = 0;
  RICOCHET_TRY(const SolveResponse timed, solver.Solve(more));
  return DurationPlot(timed.outcome);
}

}  // namespace ricochet::cli
