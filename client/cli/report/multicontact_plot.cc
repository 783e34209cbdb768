#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "absl/strings/str_cat.h"
#include "client/cli/report/multicontact_report.h"
#include "client/cli/text/enum_names.h"
#include "core/types/multi_contact.h"
#include "proto/wire/multi_contact.h"

namespace ricochet::cli {
namespace {

using Points = std::vector<std::pair<double, double>>;

// Adds an arrow, whose head is a fifth of its length.
void AddArrow(const std::pair<double, double>& from, double x, double y, Points& points) {
  const std::pair<double, double> to = {from.first + x, from.second + y};
  const auto barb = [&](double side) {
    return std::pair(to.first - 0.2 * x - side * 0.1 * y, to.second - 0.2 * y + side * 0.1 * x);
  };
  points.insert(points.end(), {from, to, barb(1.0), to, barb(-1.0), {NAN, NAN}});
}

// Draws lines from centres of mass to the points of contact, and arrows for velocities and normals.
Panel StrikePanel(const FreeBodies& free, const std::vector<MultiContactPoint>& contacts) {
  Points arms, velocities, normals, centres, points;
  double size = 0.0, speed = 0.0;
  const auto position = [&](int32_t body, size_t axis) {
    return free.bodies[static_cast<size_t>(body - 1)].position_m[axis];
  };
  for (const MultiContactPoint& contact : contacts) {
    points.emplace_back(contact.point_m[0], contact.point_m[1]);
    for (const int32_t body : {contact.body, contact.other_body}) {
      if (body == 0) continue;
      arms.insert(arms.end(), {{position(body, 0), position(body, 1)}, points.back(), {NAN, NAN}});
      size =
          std::max(size, std::hypot(position(body, 0) - points.back().first, position(body, 1) - points.back().second));
    }
  }
  const auto velocity = [](const FreeBody& body, size_t axis) {
    return body.linear_m_s.empty() ? 0.0 : body.linear_m_s[axis];
  };
  for (const FreeBody& body : free.bodies) speed = std::max(speed, std::hypot(velocity(body, 0), velocity(body, 1)));
  for (const FreeBody& body : free.bodies) {
    centres.emplace_back(body.position_m[0], body.position_m[1]);
    if (speed == 0.0) continue;
    const double scale = 0.7 * size / speed;
    AddArrow(centres.back(), scale * velocity(body, 0), scale * velocity(body, 1), velocities);
  }
  for (size_t i = 0; i < contacts.size(); ++i) {
    const double scale = 0.3 * size / std::hypot(contacts[i].normal[0], contacts[i].normal[1]);
    AddArrow(points[i], scale * contacts[i].normal[0], scale * contacts[i].normal[1], normals);
  }
  Panel panel = {.title = "Before", .x_label = "x [m]", .y_label = "y [m]", .equal_scales = true};
  panel.curves = {
      {.title = "", .points = arms, .style = "with lines linewidth 2 linecolor rgb '#999999'"},
      {.title = "velocity", .points = velocities, .style = "with lines linewidth 3 linecolor rgb '#0072B2'"},
      {.title = "normal", .points = normals, .style = "with lines linewidth 3 linecolor rgb '#D55E00'"},
      {.title = "centre of mass", .points = centres, .style = "with points pointtype 7 linecolor rgb 'black'"},
      {.title = "contact", .points = points, .style = "with points pointtype 6 linecolor rgb '#D55E00'"}};
  return panel;
}

// Draws the outcomes as marks on bars, which show what is possible.
Panel OutcomesPanel(const MultiContactRequest& request, const MultiContactAnswer& answer) {
  Panel panel = {.title = "Outcomes within what is possible", .x_label = "velocity after [m/s, rad/s]"};
  std::vector<std::string> names;
  for (const PossibleRange& range : answer.possible) names.push_back(range.output);
  if (names.empty()) names = OutputNames(request);
  Points bars, orders, springs;
  const auto height = [&](size_t i) { return static_cast<double>(names.size() - i); };
  for (size_t i = 0; i < names.size(); ++i) {
    panel.y_ticks.push_back({height(i), names[i]});
    if (answer.possible.empty()) continue;
    bars.insert(bars.end(), {{answer.possible[i].lower, height(i)}, {answer.possible[i].upper, height(i)}, {NAN, NAN}});
  }
  const auto add = [&](const AttainedOutcome& outcome, Points& points) {
    const std::vector<double> numbers = NumbersOf(outcome);
    for (size_t i = 0; i < numbers.size(); ++i) points.emplace_back(numbers[i], height(i));
  };
  for (const AttainedOutcome& outcome : answer.orders) add(outcome, orders);
  if (answer.springs.has_value()) add(*answer.springs, springs);
  panel.curves = {
      {.title = "possible", .points = bars, .style = "with lines linewidth 9 linecolor rgb '#BBDDEE'"},
      {.title = "orders", .points = orders, .style = "with points pointtype 6 pointsize 1.2 linecolor rgb '#D55E00'"},
      {.title = "springs", .points = springs, .style = "with points pointtype 2 pointsize 1.2 linecolor rgb 'black'"}};
  std::erase_if(panel.curves, [](const Curve& curve) { return curve.points.empty(); });
  return panel;
}

// Draws the velocities after, of bodies or else of contacts, over the stiffness.
Panel StiffnessPanel(const MultiContactRequest& request, const MultiContactAnswer& answer) {
  const std::vector<StiffnessSample>& samples = answer.stiffness_samples;
  Panel panel = {.title = "Springs",
                 .x_label = absl::StrCat("relative stiffness of contact ", request.stiffness_range->contact),
                 .y_label = "velocity after [m/s, rad/s]",
                 .log_x = true};
  const AttainedOutcome& first = samples.front().outcome;
  const std::vector<std::string> names = OutputNames(request);
  const size_t start = first.velocity.empty() ? 0 : first.contact_velocity_m_s.size();
  for (size_t i = start; i < names.size(); ++i) {
    Curve& curve = panel.curves.emplace_back(Curve{.title = names[i], .points = {}});
    for (const StiffnessSample& sample : samples) {
      if (!HasEnd(sample.outcome.end)) continue;
      curve.points.emplace_back(sample.relative_stiffness, NumbersOf(sample.outcome)[i]);
    }
  }
  for (const StiffnessJump& jump : answer.stiffness_jumps) panel.x_marks.push_back(jump.low);
  return panel;
}

}  // namespace

Plot MultiContactPlot(const MultiContactRequest& request, const MultiContactResponse& response) {
  const MultiContactAnswer& answer = response.answers.front();
  Plot plot = {.title = absl::StrCat("Several contacts: ", EnumName(answer.verdict)), .panels = {}};
  const auto* const free = std::get_if<FreeBodies>(&request.scene.system);
  if (free != nullptr && free->bodies.front().position_m.size() == 2) {
    plot.panels.push_back(StrikePanel(*free, request.scene.contacts));
  }
  plot.panels.push_back(OutcomesPanel(request, answer));
  if (!answer.stiffness_samples.empty()) plot.panels.push_back(StiffnessPanel(request, answer));
  return plot;
}

}  // namespace ricochet::cli
